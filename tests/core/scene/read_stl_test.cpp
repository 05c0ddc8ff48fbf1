#include "hbar/core/scene/read_stl.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_meshes.h"

namespace hbar::scene {
namespace {

void put(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) {
    bytes += static_cast<char>(word >> (8 * i) & 255U);
  }
}

std::string binary(const TriangleMesh& mesh, const std::string& header = "made by a test") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const std::array<int, 3>& t : mesh.triangles) {
    bytes.append(12, '\0');  // a normal of zeros: it does not count
    for (const int corner : t) {
      for (const double x : mesh.vertices[static_cast<std::size_t>(corner)]) {
        put(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ascii(const TriangleMesh& mesh) {
  std::string text = "solid a part\n";
  for (const std::array<int, 3>& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int corner : t) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(corner)];
      text += concat("  vertex ", p.x(), ' ', p.y(), ' ', p.z(), '\n');
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid a part\n";
}

std::string stl_refusal(const std::string& bytes) {
  return hbar::testing::message_of<InvalidInput>(
      [&] { static_cast<void>(read_stl_bytes(bytes, "m")); });
}

TEST(ReadStl, ReadsBinaryAndAsciiFiles) {
  const TriangleMesh box = box_mesh({1.0, 2.0, 4.0});
  for (const std::string& bytes :
       {binary(box), binary(box, "solid, but binary"), ascii(box), "\xef\xbb\xbf" + ascii(box)}) {
    const PolygonMesh mesh = read_stl_bytes(bytes, "m");
    EXPECT_EQ(mesh.polygons.size(), 12U);
    const MendedMesh closed = triangulated(mesh, "m");
    EXPECT_TRUE(closed.notices.empty());
    EXPECT_EQ(closed.mesh.vertices.size(), 8U);
    EXPECT_NEAR(solid_moments(closed.mesh).volume, 8.0, 1e-14);
  }
}

TEST(ReadStl, RefusesWithTheWholeMessage) {
  const TriangleMesh box = box_mesh({1.0, 2.0, 4.0});
  const std::string whole = binary(box);
  EXPECT_EQ(stl_refusal(whole.substr(0, whole.size() - 1)),
            "m: the file has 683 bytes; its 12 facets would take 684");
  EXPECT_EQ(stl_refusal(whole + "x"), "m: the file has 685 bytes; its 12 facets would take 684");
  EXPECT_EQ(stl_refusal("STL"),
            "m: this is no STL file: neither \"solid\" nor a header of 84 bytes");
  std::string bad = whole;
  bad[84 + 50 + 12 + 3] = '\x7f';
  bad[84 + 50 + 12 + 2] = '\x80';
  EXPECT_EQ(stl_refusal(bad), "m: facet 2: a coordinate is not finite");
  EXPECT_EQ(stl_refusal(binary({{}, {}})),
            "m: the file has no facet; a solid is bounded by facets");
  const std::string text = ascii(box);
  EXPECT_EQ(stl_refusal(text.substr(0, text.rfind("endsolid"))),
            "m:85: the file does not end with \"endsolid\": it was cut");
  EXPECT_EQ(stl_refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"),
            "m:4: \"x\" is not a finite number; a point is 3 numbers");
  EXPECT_EQ(stl_refusal("solid\nfacet\nvertex 0 0 1\nvertex 0 1 1\nendfacet\nendsolid\n"),
            "m:5: the facet has 2 vertices; it has three");
  EXPECT_EQ(stl_refusal("solid\nvertex 0 0 1\n"), "m:2: a facet has three lines \"vertex x y z\"");
  EXPECT_EQ(stl_refusal("solid\nfaces\n"),
            "m:2: unknown word \"faces\"; known: solid, facet, outer loop, vertex, endloop, "
            "endfacet, endsolid");
  EXPECT_EQ(stl_refusal("solid\nendsolid\n"),
            "m: the file has no facet; a solid is bounded by facets");
}

}  // namespace
}  // namespace hbar::scene
