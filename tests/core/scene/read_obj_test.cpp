#include "hbar/core/scene/read_obj.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/scene/bad_files.h"

namespace hbar::scene {
namespace {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

using Faces = std::vector<std::vector<int>>;

Faces faces_of(const PolygonMesh& mesh) {
  Faces out;
  for (const Polygon& polygon : mesh.polygons) {
    out.push_back(polygon.corners);
  }
  return out;
}

TEST(ReadObj, ReadsEveryFormOfCorner) {
  const PolygonMesh mesh = read_obj_text(
      "# a comment\nmtllib a.mtl\no thing\ng part\nusemtl red\ns off\n" + kVertices +
          "vt 0 0\nvn 0 0 1\nvp 1 2\nl 1 2\np 3\nf 1 2 3\nf 1/1 2/1 3/1 # three\n"
          "f 1//1 2//1 4//1\r\nf 1/1/1 2/1/1 4/1/1\nf 1/ 2// 4/1/\nf -1 -2 -3\nf 1 2 3 4\n",
      "a.obj");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3d::UnitZ());
  EXPECT_EQ(
      faces_of(mesh),
      (Faces{{0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 3}, {0, 1, 3}, {3, 2, 1}, {0, 1, 2, 3}}));
  EXPECT_EQ(mesh.polygons[0].line, 16);
}

TEST(ReadObj, ReadsMarksContinuationsAndFacesBeforeVertices) {
  const PolygonMesh mesh = read_obj_text(
      "\xef\xbb\xbf# made by hand\nf 1 2 \\\n  3\nv 0 0 \\\r\n 0\nv 1 0 0\nv 0 1 0\n"
      "f 1 3 2\\",
      "a.obj");
  EXPECT_EQ(faces_of(mesh), (Faces{{0, 1, 2}, {0, 2, 1}}));
  EXPECT_EQ(mesh.polygons[0].line, 2);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d::Zero());
}

TEST(ReadObj, ReadsWeightsAndColours) {
  const PolygonMesh mesh =
      read_obj_text("v 1 2 3 1\nv 4 5 6 0.5 0.5 0.5\nv 7 8 9 1 0.5 0.5 0.5\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(7.0, 8.0, 9.0));
}

TEST(ReadObj, RefusesWithTheWholeMessage) {
  const std::string form = "; a corner is v, v/vt, v//vn or v/vt/vn";
  expect_refused(
      {{"empty", "", "bad:1: the file has no face; a solid is bounded by faces"},
       {"no face", kVertices, "bad:4: the file has no face; a solid is bounded by faces"},
       {"not a number", "v 0 0 nan", "bad:1: \"nan\" is not a finite number; a point is 3 numbers"},
       {"trailing letter", "\nv 0 0 1m",
        "bad:2: \"1m\" is not a finite number; a point is 3 numbers"},
       {"two numbers", "v 0 0",
        "bad:1: v has 2 numbers; a vertex is v x y z, with a weight or a colour"},
       {"index too large", kVertices + "f 1 2 5", "bad:5: vertex 5 does not exist; the file has 4"},
       {"index zero", kVertices + "f 0 1 2",
        "bad:5: vertex 0 does not exist; they are counted from 1"},
       {"index too far back", kVertices + "f -5 1 2",
        "bad:5: vertex -5 does not exist; 4 are defined before this line"},
       {"index not whole", kVertices + "f 1.5 2 3",
        "bad:5: \"1.5\": \"1.5\" is not a whole number" + form},
       {"corner without vertex", kVertices + "f /1 2 3",
        "bad:5: \"/1\": \"\" is not a whole number" + form},
       {"corner of four parts", kVertices + "f 1/1/1/1 2 3",
        "bad:5: \"1/1/1/1\" has too many /" + form},
       {"two corners", kVertices + "f 1 2", "bad:5: f has 2 corners; a face has at least 3"},
       {"unknown keyword", kVertices + "curv 1 2",
        "bad:5: unknown keyword \"curv\"; known: v, f, and skipped: vt, vn, vp, g, o, s, usemtl, "
        "mtllib, l, p"}},
      [](const std::string& text, const std::string& name) { return read_obj_text(text, name); });
}

}  // namespace
}  // namespace hbar::scene
