#include "hbar/core/scene/read_obj.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

struct BadFile {
  const char* name;
  std::string text;
  std::string message;
};

template <typename Read>
void expect_refused(const std::vector<BadFile>& files, Read&& read) {
  for (const BadFile& file : files) {
    SCOPED_TRACE(file.name);
    try {
      static_cast<void>(read(file.text, "bad"));
      ADD_FAILURE() << "was read";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.what(), file.message);
    }
  }
}

TEST(ReadObj, ReadsEveryFormOfCorner) {
  const TriangleMesh mesh = read_obj_text(
      "# a comment\nmtllib a.mtl\no thing\ng part\nusemtl red\ns off\n" + kVertices +
          "vt 0 0\nvn 0 0 1\nvp 1 2\nf 1 2 3\nf 1/1 2/1 3/1 # three\nf 1//1 2//1 4//1\r\n"
          "f 1/1/1 2/1/1 4/1/1\nf -1 -2 -3\nf 1 2 3 4\n",
      "a.obj");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3d::UnitZ());
  using Triangles = std::vector<std::array<int, 3>>;
  EXPECT_EQ(
      mesh.triangles,
      (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 3}, {3, 2, 1}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadObj, ReadsWeightsAndColours) {
  const TriangleMesh mesh =
      read_obj_text("v 1 2 3 1\nv 4 5 6 0.5 0.5 0.5\nv 7 8 9 1 0.5 0.5 0.5\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(7.0, 8.0, 9.0));
}

TEST(ReadObj, ReadsTheRecordedWedge) {
  const TriangleMesh mesh = read_obj(HBAR_SOURCE_DIR "/tests/golden/scenes/wedge.obj");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_THROW(static_cast<void>(read_obj("/no/such.obj")), IoError);
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
       {"index too large", kVertices + "f 1 2 5",
        "bad:5: vertex 5 does not exist; 4 are defined before this line"},
       {"index zero", kVertices + "f 0 1 2",
        "bad:5: vertex 0 does not exist; 4 are defined before this line"},
       {"index too far back", kVertices + "f -5 1 2",
        "bad:5: vertex -5 does not exist; 4 are defined before this line"},
       {"index not whole", kVertices + "f 1.5 2 3",
        "bad:5: \"1.5\": \"1.5\" is not a whole number" + form},
       {"corner without vertex", kVertices + "f /1 2 3",
        "bad:5: \"/1\": \"\" is not a whole number" + form},
       {"corner that ends in a slash", kVertices + "f 1/ 2 3",
        "bad:5: \"1/\": \"\" is not a whole number" + form},
       {"corner of four parts", kVertices + "f 1/1/1/1 2 3",
        "bad:5: \"1/1/1/1\" has too many /" + form},
       {"two corners", kVertices + "f 1 2", "bad:5: f has 2 corners; a face has at least 3"},
       {"repeated corner", kVertices + "f 1 2 1",
        "bad:5: f has vertex 1 twice; its corners must differ"},
       {"unknown keyword", kVertices + "curv 1 2",
        "bad:5: unknown keyword \"curv\"; known: v, f, and skipped: vt, vn, vp, g, o, s, usemtl, "
        "mtllib"}},
      [](const std::string& text, const std::string& name) { return read_obj_text(text, name); });
}

TEST(ReadContacts, ReadsACountAndPoints) {
  const auto points = read_contacts_text("2\n1 2 3\n\n4 5 6\n", "c.txt");
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1], Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_TRUE(read_contacts_text("0\n", "c.txt").empty());
  EXPECT_THROW(static_cast<void>(read_contacts("/no/such.txt")), IoError);
}

TEST(ReadContacts, RefusesWithTheWholeMessage) {
  expect_refused(
      {{"empty", "", "bad:1: the file is empty; it begins with the number of points"},
       {"no count", "1 2 3\n",
        "bad:1: the file begins with the number of points, alone in its line"},
       {"broken count", "1.5\n",
        "bad:1: \"1.5\" is not a whole number; the file begins with the number of points"},
       {"too few points", "3\n1 2 3\n", "bad:2: found 1 points; the first line says 3"},
       {"too many points", "0\n1 2 3\n", "bad:2: found 1 points; the first line says 0"},
       {"two numbers", "1\n1 2\n", "bad:2: found 2 words; a point is x y z"},
       {"not finite", "1\n1 2 inf\n",
        "bad:2: \"inf\" is not a finite number; a point is 3 numbers"}},
      [](const std::string& text, const std::string& name) {
        return read_contacts_text(text, name);
      });
}

TEST(ReadSensorPoints, ReadsPointsWithAxesOfUnitLength) {
  const auto points =
      read_sensor_points_text("2\n1 2 3  2 0 0  0 0 -3\n4 5 6  0 0 1  1e-200 1e-200 0\n", "s.txt");
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].position, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(points[0].axis0, Eigen::Vector3d::UnitX());
  EXPECT_EQ(points[0].axis1, -Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(points[1].axis1.norm(), 1.0, 1e-15);
  EXPECT_THROW(static_cast<void>(read_sensor_points("/no/such.txt")), IoError);
}

TEST(ReadSensorPoints, RefusesWithTheWholeMessage) {
  const std::string parallel = "bad:2: the axes a0 and a1 are zero or parallel; they span a plane";
  expect_refused(
      {{"no axes", "1\n1 2 3\n",
        "bad:2: found 3 words; a point is x y z, then its axes a0x a0y a0z and a1x a1y a1z"},
       {"not a number", "1\n1 2 3 1 0 0 0 x 0\n",
        "bad:2: \"x\" is not a finite number; a point is 3 numbers"},
       {"no axis", "1\n1 2 3 1 0 0 0 0 0\n", parallel},
       {"parallel axes", "1\n1 2 3 1 0 0 -2 0 0\n", parallel},
       {"too few points", "2\n1 2 3 1 0 0 0 1 0\n",
        "bad:2: found 1 points; the first line says 2"}},
      [](const std::string& text, const std::string& name) {
        return read_sensor_points_text(text, name);
      });
}

}  // namespace
}  // namespace hbar::scene
