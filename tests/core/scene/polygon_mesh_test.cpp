#include "hbar/core/scene/polygon_mesh.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/mesh_overlap.h"
#include "hbar/core/scene/read_obj.h"
#include "tests/support/message_of.h"

namespace hbar::scene {
namespace {

/// An L-shaped prism with caps of six corners, as CAD programs write it: three cubes of 1.
std::string bracket() {
  return "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
         "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
         "f 7 8 9 10 11 12\nf 6 5 4 3 2 1\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\n"
         "f 5 6 12 11\nf 6 1 7 12\n";
}

MendedMesh mesh_of(const std::string& obj) { return triangulated(read_obj_text(obj, "m"), "m"); }

std::string mesh_refusal(const std::string& obj) {
  return hbar::testing::message_of<InvalidInput>([&] { static_cast<void>(mesh_of(obj)); });
}

TEST(PolygonMesh, ConcaveFacesBoundTheSolidTheyOutline) {
  const MendedMesh mended = mesh_of(bracket());
  EXPECT_TRUE(mended.notices.empty());
  EXPECT_EQ(mended.mesh.triangles.size(), 20U);
  EXPECT_NO_THROW(check_solid(mended.mesh));
  EXPECT_NO_THROW(check_overlap(mended.mesh));
  const SolidMoments moments = solid_moments(mended.mesh);
  EXPECT_NEAR(moments.volume, 3.0, 1e-14);
  EXPECT_LT((moments.centre - Eigen::Vector3d(5.0 / 6.0, 5.0 / 6.0, 0.5)).norm(), 1e-14);
}

TEST(PolygonMesh, FacesOfTooFewVerticesAreDropped) {
  const MendedMesh mended = mesh_of(bracket() + "f 1 1 2\nf 3 3 3\n");
  EXPECT_EQ(mended.notices,
            std::vector<std::string>{"2 faces have fewer than 3 vertices: dropped"});
  EXPECT_TRUE(is_closed(mended.mesh));
  EXPECT_EQ(mesh_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2 3 3\n").mesh.triangles.size(), 1U);
}

TEST(PolygonMesh, RefusesWithTheWholeMessage) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\n";
  EXPECT_EQ(mesh_refusal(square + "f 1 2 3 1 4\n"),
            "m:7: the face has vertex 1 twice; its corners must differ");
  EXPECT_EQ(mesh_refusal(square + "\nf 1 2 5 6\n"),
            "m:8: the corners lie on a line; a face has an area");
  EXPECT_EQ(mesh_refusal(square + "f 1 3 2 4\n"),
            "m:7: the corners lie on a line; a face has an area");
  EXPECT_EQ(mesh_refusal("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n"),
            "m:5: the face cuts or touches itself; its corners must bound a simple polygon");
}

}  // namespace
}  // namespace hbar::scene
