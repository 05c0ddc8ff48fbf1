#include "hbar/core/geometry/mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>

#include "hbar/core/base/error.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

/// A box from the origin to `size`, corners numbered by the bits x, y, z.
TriangleMesh box(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) * size.x(), (i / 2 & 1) * size.y(), (i / 4) * size.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh tetrahedron() {
  return {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

std::string solid_refusal(const TriangleMesh& mesh) {
  try {
    check_solid(mesh);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SolidMoments, AreThoseOfABox) {
  const Eigen::Vector3d size(2.0, 3.0, 5.0);
  const TriangleMesh mesh = box(size);
  EXPECT_EQ(solid_refusal(mesh), "accepted");
  const SolidMoments moments = solid_moments(mesh);
  EXPECT_NEAR(moments.volume, 30.0, 1e-13);
  EXPECT_LT((moments.centre - size / 2.0).norm(), 1e-14);
  const Eigen::Vector3d expected(30.0 / 12.0 * (9.0 + 25.0), 30.0 / 12.0 * (4.0 + 25.0),
                                 30.0 / 12.0 * (4.0 + 9.0));
  EXPECT_LT((moments.inertia - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-12);
}

TEST(SolidMoments, AreThoseOfATetrahedron) {
  const SolidMoments moments = solid_moments(tetrahedron());
  EXPECT_NEAR(moments.volume, 1.0 / 6.0, 1e-16);
  EXPECT_LT((moments.centre - Eigen::Vector3d::Constant(0.25)).norm(), 1e-16);
  // About the centre: ∫x² = 1/60 − 1/96 = 1/160 and ∫xy = 1/120 − 1/96 = −1/480.
  Eigen::Matrix3d expected = Eigen::Matrix3d::Constant(1.0 / 480.0);
  expected.diagonal().setConstant(2.0 / 160.0);
  EXPECT_LT((moments.inertia - expected).norm(), 1e-16);
}

TEST(SolidMoments, MoveAndTurnWithTheMesh) {
  const TriangleMesh mesh = box({0.2, 0.3, 0.5});
  const SolidMoments moments = solid_moments(mesh);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d p(100.0, -200.0, 300.0);
  TriangleMesh moved = mesh;
  for (Eigen::Vector3d& point : moved.vertices) {
    point = R * point + p;
  }
  EXPECT_EQ(solid_refusal(moved), "accepted");
  const SolidMoments other = solid_moments(moved);
  EXPECT_NEAR(other.volume, moments.volume, 1e-13);
  EXPECT_LT((other.centre - R * moments.centre - p).norm(), 1e-12);
  EXPECT_LT((other.inertia - R * moments.inertia * R.transpose()).norm(), 1e-13);
}

TEST(SolidMoments, ScaleWithTheFifthPower) {
  const SolidMoments one = solid_moments(box({1.0, 2.0, 3.0}));
  const SolidMoments two = solid_moments(box({2.0, 4.0, 6.0}));
  EXPECT_NEAR(two.volume, 8.0 * one.volume, 1e-12);
  EXPECT_LT((two.inertia - 32.0 * one.inertia).norm(), 1e-11);
}

TEST(CheckSolid, RefusesWithTheWholeMessage) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.clear();
  EXPECT_EQ(solid_refusal(mesh), "mesh: no triangle; a solid needs at least 4");
  mesh = tetrahedron();
  mesh.vertices[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solid_refusal(mesh), "mesh: vertex 2 is (1, nan, 0); coordinates must be finite");
  mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  EXPECT_EQ(solid_refusal(mesh), "mesh: triangle 3 has vertex 5; there are 4");
  mesh = tetrahedron();
  mesh.vertices[2] = {2.0, 0.0, 0.0};
  EXPECT_EQ(solid_refusal(mesh),
            "mesh: triangle 1 at (0, 0, 0) has no area; its corners must not lie on a line");
  mesh = tetrahedron();
  mesh.triangles.pop_back();
  EXPECT_EQ(solid_refusal(mesh),
            "mesh: the edge from (0, 1, 0) to (1, 0, 0) has one triangle; a closed surface has two "
            "at each edge");
  mesh = tetrahedron();
  mesh.triangles.push_back(mesh.triangles[0]);
  EXPECT_EQ(solid_refusal(mesh),
            "mesh: the edge from (0, 0, 0) to (0, 1, 0) has 3 triangles, 2 of one orientation; a "
            "closed surface has as many of each");
  mesh = tetrahedron();
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  EXPECT_EQ(solid_refusal(mesh),
            "mesh: the edge from (0, 0, 0) to (1, 0, 0) has two triangles of opposite orientation; "
            "all corners must run counter-clockwise seen from outside");
  mesh = tetrahedron();
  for (auto& triangle : mesh.triangles) {
    std::swap(triangle[1], triangle[2]);
  }
  EXPECT_EQ(solid_refusal(mesh).substr(0, 49), "mesh: the surface encloses the volume -0.166667; ");
}

TEST(CheckSolid, ASurfaceMayTouchItself) {
  const TriangleMesh one = box({1.0, 1.0, 1.0});
  const TriangleMesh touching =
      merge_equal_vertices(together(one, moved(one, Eigen::Vector3d(1.0, 1.0, 0.0))));
  ASSERT_EQ(touching.vertices.size(), 14U);  // an edge is shared
  EXPECT_TRUE(is_closed(touching));
  EXPECT_EQ(solid_refusal(touching), "accepted");
  EXPECT_NEAR(solid_moments(touching).volume, 2.0, 1e-15);
}

TEST(MergeEqualVertices, ClosesASurfaceOfLooseTriangles) {
  const TriangleMesh mesh = tetrahedron();
  TriangleMesh loose;
  for (const auto& triangle : mesh.triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int index : triangle) {
      loose.vertices.push_back(mesh.vertices[static_cast<std::size_t>(index)]);
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_FALSE(is_closed(loose));
  const TriangleMesh merged = merge_equal_vertices(loose);
  EXPECT_TRUE(is_closed(merged));
  EXPECT_EQ(merged.vertices.size(), 4U);
  EXPECT_EQ(solid_refusal(merged), "accepted");
}

}  // namespace
}  // namespace hbar
