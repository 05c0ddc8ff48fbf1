#include "hbar/core/scene/read_assimp.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"

namespace hbar::scene {
namespace {

/// A box of 1 x 2 x 4 with faces of four corners.
std::string ply_box() {
  return "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
         "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n1 2 0\n0 2 0\n0 0 4\n1 0 4\n1 2 4\n0 2 4\n"
         "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
}

/// A tetrahedron of legs 1 in millimetres, mirrored by its node.
std::string dae_tetrahedron(const std::string& matrix) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><matrix>)" +
         matrix + R"(</matrix><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

TEST(ReadAssimp, ReadsPly) {
  const MendedMesh box = triangulated(read_assimp_bytes(ply_box(), "ply", "m.ply"), "m.ply");
  EXPECT_NO_THROW(check_solid(box.mesh));
  EXPECT_NEAR(solid_moments(box.mesh).volume, 8.0, 1e-13);
}

TEST(ReadAssimp, AppliesTransformsAndUnits) {
  for (const char* matrix :
       {"1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1", "-1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1"}) {
    const MendedMesh mesh =
        triangulated(read_assimp_bytes(dae_tetrahedron(matrix), "dae", "m.dae"), "m.dae");
    EXPECT_NO_THROW(check_solid(mesh.mesh)) << matrix;
    const SolidMoments moments = solid_moments(mesh.mesh);
    EXPECT_NEAR(moments.volume, 1e-9 / 6.0, 1e-15);
    const double x = matrix[0] == '-' ? 4.75 : 5.25;
    EXPECT_LT((1e3 * moments.centre - Eigen::Vector3d(x, 0.25, 0.25)).norm(), 1e-5);
  }
}

TEST(ReadAssimp, RefusesWhatItCannotRead) {
  const auto refusal = [](const std::string& text, const char* kind) {
    return hbar::testing::message_of<InvalidInput>(
        [&] { static_cast<void>(read_assimp_bytes(text, kind, "m")); });
  };
  EXPECT_EQ(refusal("not a mesh", "ply").substr(0, 19), "m: cannot be read: ");
  EXPECT_EQ(refusal("", "dae").substr(0, 19), "m: cannot be read: ");
  EXPECT_EQ(refusal("{}", "gltf").substr(0, 19), "m: cannot be read: ");
}

}  // namespace
}  // namespace hbar::scene
