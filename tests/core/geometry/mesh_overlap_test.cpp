#include "hbar/core/geometry/mesh_overlap.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

std::string refusal(const TriangleMesh& mesh) {
  return testing::message_of<InvalidInput>([&] { check_overlap(mesh); });
}

TEST(CheckOverlap, AcceptsSolids) {
  EXPECT_EQ(refusal(box_mesh({1.0, 2.0, 3.0})), "");
  EXPECT_EQ(refusal(icosphere(1.0, 3)), "");
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(refusal(star_mesh(2, seed)), "") << seed;
  }
  EXPECT_EQ(refusal(box_mesh({1.0, 1.0, 1e-5})), "");  // a thin plate
}

TEST(CheckOverlap, AcceptsCavitiesAndSolidsApart) {
  const TriangleMesh ball = icosphere(1.0, 2);
  EXPECT_EQ(refusal(together(box_mesh({3.0, 3.0, 3.0}), turned_inside_out(ball))), "");
  EXPECT_EQ(refusal(together(ball, moved(ball, {2.5, 0.0, 0.0}))), "");
  // A ball in the cavity of a box.
  EXPECT_EQ(refusal(together(together(box_mesh({3.0, 3.0, 3.0}), turned_inside_out(ball)),
                             icosphere(0.5, 1))),
            "");
}

TEST(CheckOverlap, RefusesSolidsThatOverlap) {
  const TriangleMesh cube = box_mesh({0.2, 0.2, 0.2});
  // By half along an axis: no edge passes through a face, but faces lie within.
  EXPECT_EQ(refusal(together(cube, moved(cube, {0.1, 0.0, 0.0}))).substr(0, 22),
            "mesh: the triangle at ");
  EXPECT_EQ(
      refusal(together(icosphere(1.0, 2), moved(icosphere(1.0, 2), {0.9, 0.1, 0.2}))).substr(0, 32),
      "mesh: the surface cuts itself at");
  EXPECT_NE(
      refusal(together(box_mesh({3.0, 3.0, 3.0}), icosphere(1.0, 2)))
          .find("lies inside the solid: the surface overlaps itself, or holds two solids that "
                "overlap"),
      std::string::npos);
  EXPECT_NE(refusal(together(cube, cube)).find("lies inside the solid"), std::string::npos);
}

TEST(CheckOverlap, RefusesASurfaceThatCutsItself) {
  TriangleMesh star = icosphere(1.0, 2);
  star.vertices[0] = -1.5 * star.vertices[0];  // pulled through the other side
  EXPECT_EQ(refusal(star).substr(0, 32), "mesh: the surface cuts itself at");
}

TEST(CheckOverlap, RefusesAPartThatIsTurnedInsideOut) {
  const TriangleMesh ball = icosphere(1.0, 1);
  EXPECT_NE(refusal(together(box_mesh({3.0, 3.0, 3.0}),
                             turned_inside_out(moved(icosphere(1.0, 1), {9.0, 0.0, 0.0}))))
                .find("is turned inside out"),
            std::string::npos);
  EXPECT_NE(refusal(turned_inside_out(ball)).find("is turned inside out"), std::string::npos);
}

TEST(CheckOverlap, DoesNotDependOnPlaceSizeAndTurn) {
  const TriangleMesh cube = box_mesh({0.2, 0.2, 0.2});
  const TriangleMesh bad = together(cube, moved(cube, {0.1, 0.0, 0.0}));
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (const double size : {1e-6, 1.0, 1e6}) {
    for (const TriangleMesh& mesh : {bad, star_mesh(2, 3)}) {
      TriangleMesh other = mesh;
      for (Eigen::Vector3d& vertex : other.vertices) {
        vertex = size * (R * vertex + Eigen::Vector3d(3.0, -2.0, 1.0));
      }
      EXPECT_EQ(refusal(other).empty(), refusal(mesh).empty()) << size;
    }
  }
}

}  // namespace
}  // namespace hbar
