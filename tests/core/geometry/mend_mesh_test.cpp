#include "hbar/core/geometry/mend_mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/mesh_overlap.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

using Notices = std::vector<std::string>;

/// Every triangle with vertices of its own, each moved by up to `noise`.
TriangleMesh loose(const TriangleMesh& mesh, double noise) {
  std::mt19937 random(8);
  TriangleMesh out;
  for (const std::array<int, 3>& t : mesh.triangles) {
    const int first = static_cast<int>(out.vertices.size());
    for (const int corner : t) {
      out.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)] +
                             random_point(random, noise));
    }
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

void expect_solid(const MendedMesh& mended, double volume, double tolerance = 1e-13) {
  EXPECT_NO_THROW(check_solid(mended.mesh));
  EXPECT_NO_THROW(check_overlap(mended.mesh));
  EXPECT_NEAR(solid_moments(mended.mesh).volume, volume, tolerance * volume);
}

TEST(MendMesh, LeavesAClosedSurfaceAlone) {
  const TriangleMesh star = star_mesh(2, 1);
  const MendedMesh mended = mend_mesh(star);
  EXPECT_EQ(mended.mesh.vertices, star.vertices);
  EXPECT_EQ(mended.mesh.triangles, star.triangles);
  EXPECT_EQ(mended.notices, Notices());
}

TEST(MendMesh, MergesEqualAndNearVertices) {
  const TriangleMesh star = star_mesh(2, 1);
  const double volume = solid_moments(star).volume;
  const MendedMesh equal = mend_mesh(loose(star, 0.0));
  EXPECT_EQ(equal.mesh.vertices.size(), star.vertices.size());
  EXPECT_EQ(equal.notices, Notices());
  expect_solid(equal, volume);
  const MendedMesh near = mend_mesh(loose(star, 1e-8));
  EXPECT_EQ(near.mesh.vertices.size(), star.vertices.size());
  EXPECT_EQ(near.notices,
            Notices({"798 vertices lie within 1e-6 of the bounding box's diagonal of others: "
                     "merged"}));
  expect_solid(near, volume, 1e-6);
  // A gap is no rounding.
  EXPECT_FALSE(is_closed(mend_mesh(loose(star, 1e-4)).mesh));
}

TEST(MendMesh, DropsTrianglesWithoutArea) {
  TriangleMesh box = box_mesh({1.0, 2.0, 3.0});
  box.triangles.push_back({0, 0, 1});
  EXPECT_EQ(mend_mesh(box).notices, Notices());
  expect_solid(mend_mesh(box), 6.0);
}

/// The edge from 0 to 1 of a box has a vertex in its middle, on the one side only.
TriangleMesh box_with_t_vertex() {
  TriangleMesh box = box_mesh({1.0, 2.0, 3.0});
  const int middle = static_cast<int>(box.vertices.size());
  box.vertices.push_back(0.5 * (box.vertices[0] + box.vertices[1]));
  EXPECT_EQ(box.triangles[4], (std::array<int, 3>{0, 1, 4}));
  box.triangles[4] = {0, middle, 4};
  box.triangles.push_back({middle, 1, 4});
  return box;
}

TEST(MendMesh, SplitsTrianglesAtVerticesOnTheirEdges) {
  const MendedMesh mended = mend_mesh(box_with_t_vertex());
  EXPECT_EQ(mended.notices, Notices({"a triangle has another's vertex on its edge: split"}));
  expect_solid(mended, 6.0);
  // As some programs close it: by a triangle without area.
  TriangleMesh closed = box_with_t_vertex();
  closed.triangles.push_back({0, 1, 8});
  ASSERT_TRUE(is_closed(closed));
  const MendedMesh again = mend_mesh(closed);
  EXPECT_EQ(again.notices, Notices({"a triangle has no area: dropped",
                                    "a triangle has another's vertex on its edge: split"}));
  expect_solid(again, 6.0);
}

TEST(MendMesh, SplitsAnEdgeAtSeveralVertices) {
  TriangleMesh box = box_mesh({1.0, 2.0, 3.0});
  ASSERT_EQ(box.triangles[4], (std::array<int, 3>{0, 1, 4}));
  int last = 0;
  for (const double share : {0.2, 0.3, 0.7, 0.95}) {
    box.vertices.push_back((1.0 - share) * box.vertices[0] + share * box.vertices[1]);
    const int next = static_cast<int>(box.vertices.size()) - 1;
    box.triangles.push_back({last, next, 4});
    last = next;
  }
  box.triangles[4] = {last, 1, 4};
  const MendedMesh mended = mend_mesh(box);
  EXPECT_EQ(mended.notices, Notices({"4 triangles have another's vertex on their edge: split"}));
  expect_solid(mended, 6.0);
}

TEST(MendMesh, SolidsThatShareAFaceAreOne) {
  const TriangleMesh one = box_mesh({1.0, 1.0, 1.0});
  TriangleMesh two = together(one, moved(one, Eigen::Vector3d::UnitX()));
  // The shared face is cut along the same diagonal on both sides: mirrored on one.
  two.triangles[10] = {1, 3, 7};
  two.triangles[11] = {1, 7, 5};
  two.triangles[20] = {8, 12, 14};
  two.triangles[21] = {8, 14, 10};
  const MendedMesh mended = mend_mesh(merge_equal_vertices(two));
  EXPECT_EQ(mended.notices,
            Notices({"2 pairs of triangles face each other on the same corners: dropped"}));
  expect_solid(mended, 2.0);
  EXPECT_EQ(mended.mesh.triangles.size(), 20U);
}

TEST(MendMesh, RefusesIndicesAndNumbersThatAreNone) {
  TriangleMesh box = box_mesh({1.0, 1.0, 1.0});
  box.triangles[0][1] = 8;
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(mend_mesh(box)); }),
            "mesh: a triangle has vertex 9; there are 8");
  box = box_mesh({1.0, 1.0, 1.0});
  box.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(mend_mesh(box)); }),
            "mesh: vertex 3 is not finite");
}

}  // namespace
}  // namespace hbar
