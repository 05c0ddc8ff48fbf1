#include "hbar/core/scene/read_points.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "tests/core/scene/bad_files.h"

namespace hbar::scene {
namespace {

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
       {"more points than are allowed", "1000001\n1 2 3\n",
        "bad:1: the file has 1000001 points; at most 1000000 are allowed"},
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
