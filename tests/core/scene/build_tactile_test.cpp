#include "hbar/core/scene/build_tactile.h"

#include <filesystem>
#include <fstream>

#include "hbar/core/scene/build_model.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

TEST(RectangularSensors, RunAlongTheirSecondAxisFirst) {
  const Model model = build_model(read_scene(std::string(kScenes) + "/tactile_small.xml"));
  ASSERT_EQ(model.tactile_sensors().size(), 1U);
  const hbar::TactileSensor& pad = model.tactile_sensors()[0];
  EXPECT_EQ(pad.name, "pad");
  EXPECT_EQ(pad.link, model.find_body("pad"));
  EXPECT_EQ(pad.coefficients, (ContactCoefficients{1.0, 0.03125, 2.0, 0.0625}));
  ASSERT_EQ(pad.points.cols(), 20);
  const auto at = [&pad](Eigen::Index i) { return Eigen::Vector3d(pad.points.col(i)); };
  EXPECT_LT((at(0) - Eigen::Vector3d(-0.03, 0.03, -0.01)).norm(), 1e-16);
  EXPECT_LT((at(1) - Eigen::Vector3d(-0.015, 0.03, -0.01)).norm(), 1e-16);
  EXPECT_LT((at(5) - Eigen::Vector3d(-0.03, 0.01, -0.01)).norm(), 1e-16);
  EXPECT_LT((at(19) - Eigen::Vector3d(0.03, -0.03, -0.01)).norm(), 1e-16);
  // Another program's ball under the middle of the pad touches points 7 and 12 first.
  EXPECT_LT((at(7) - Eigen::Vector3d(0.0, 0.01, -0.01)).norm(), 1e-16);
  EXPECT_LT((at(12) - Eigen::Vector3d(0.0, -0.01, -0.01)).norm(), 1e-16);
  for (Eigen::Index i = 0; i < 20; ++i) {
    EXPECT_EQ(pad.axis0.col(i), -Eigen::Vector3d::UnitY());
    EXPECT_EQ(pad.axis1.col(i), Eigen::Vector3d::UnitX());
  }
}

/// A folder with files of sensor points, for one test.
class Sensors : public ::testing::Test {
 protected:
  Sensors() {
    std::filesystem::copy_file(std::string(kScenes) + "/wedge.obj", folder_ / "wedge.obj",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder_ / "two.txt") << "2\n1 2 3 2 0 0 0 3 0\n4 5 6 0 0 1 1 0 0\n";
    std::ofstream(folder_ / "none.txt") << "0\n";
    std::ofstream(folder_ / "bad.txt") << "1\n1 2 3\n";
  }

  /// A scene of one body "a" in line 5 and a sensor on it in line 2.
  [[nodiscard]] Scene scene(const std::string& body, const std::string& sensor) const {
    return read_scene_text("<redmax>\n<sensor><tactile body=\"a\" " + sensor +
                               "/></sensor>\n<robot><link name=\"a\">\n<joint type=\"fixed\"/>\n" +
                               body + "</link></robot></redmax>",
                           "a.xml", folder_.path());
  }
  [[nodiscard]] std::string refusal(const std::string& sensor) const {
    try {
      static_cast<void>(build_model(scene("<body type=\"sphere\" radius=\"1\"/>", sensor)));
    } catch (const Error& error) {
      return error.what();
    }
    return "was built";
  }

  TemporaryFolder folder_;
};

TEST_F(Sensors, TakeAxesOfAnyAngle) {
  const Model model = build_model(
      scene(kBall,
            "type=\"rect_array\" rect_pos0=\"1 0 0\" rect_pos1=\"4 2 0\" axis0=\"5 0 0\" "
            "axis1=\"3 3 0\" resolution=\"2 3\""));
  const hbar::TactileSensor& sensor = model.tactile_sensors().at(0);
  Eigen::Matrix3Xd expected(3, 6);  // the corners differ by (1, 0) and (2, 2)
  expected << 1, 2, 3, 2, 3, 4,     //
      0, 1, 2, 0, 1, 2,             //
      0, 0, 0, 0, 0, 0;
  EXPECT_LT((sensor.points - expected).norm(), 1e-14);
  EXPECT_LT((sensor.axis1.col(0) - Eigen::Vector3d(1.0, 1.0, 0.0) / std::sqrt(2.0)).norm(), 1e-15);
}

TEST_F(Sensors, OfOnePointStandInTheMiddle) {
  const Model model = build_model(
      scene(kBall,
            "type=\"rect_array\" rect_pos0=\"0 0 1\" rect_pos1=\"2 4 1\" axis0=\"1 0 0\" "
            "axis1=\"0 1 0\" resolution=\"1 1\""));
  EXPECT_LT((model.tactile_sensors().at(0).points - Eigen::Vector3d(1.0, 2.0, 1.0)).norm(), 1e-15);
}

TEST_F(Sensors, AreListedInAFileThatIsPlaced) {
  const Model model = build_model(
      scene("<body type=\"sphere\" radius=\"1\" pos=\"9 9 9\"/>",
            "type=\"abstract\" spec=\"two.txt\" pos=\"10 20 30\" quat=\"1 0 0 1\" kn=\"2\""));
  const hbar::TactileSensor& sensor = model.tactile_sensors().at(0);
  Eigen::Matrix3Xd points(3, 2);  // the file's x is the body's y
  points << 8, 5, 21, 24, 33, 36;
  Eigen::Matrix3Xd axis0(3, 2);
  axis0 << 0, 0, 1, 0, 0, 1;
  Eigen::Matrix3Xd axis1(3, 2);
  axis1 << -1, 0, 0, 1, 0, 0;
  EXPECT_LT((sensor.points - points).norm(), 1e-13);
  EXPECT_LT((sensor.axis0 - axis0).norm(), 1e-15);
  EXPECT_LT((sensor.axis1 - axis1).norm(), 1e-15);
  EXPECT_EQ(sensor.name, "a");
  EXPECT_EQ(sensor.coefficients.kn, 2.0);
}

TEST_F(Sensors, OfMeshesAndAbstractBodiesStandInTheGivenFrame) {
  for (const std::string body :
       {"<body type=\"mesh\" filename=\"wedge.obj\" scale=\"2 3 4\" "
        "transform_type=\"OBJ_TO_JOINT\"/>",
        "<body type=\"abstract\" mass=\"1\" inertia=\"2 0.1 0.2 3 0.3 4\"/>"}) {
    SCOPED_TRACE(body);
    const Model model = build_model(scene(body, "type=\"abstract\" spec=\"two.txt\""));
    const hbar::TactileSensor& sensor = model.tactile_sensors().at(0);
    const RigidTransform<double>& X_JB = model.link(0).body.X_JB;  // the given frame is the joint's
    Eigen::Matrix3Xd given(3, 2);
    given << 1, 4, 2, 5, 3, 6;
    EXPECT_LT(((X_JB.R * sensor.points).colwise() + X_JB.p - given).norm(), 1e-14);
    EXPECT_LT((X_JB.R * sensor.axis1.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-14);
    EXPECT_GT((sensor.points - given).norm(), 1e-3) << "the frames differ";
  }
}

TEST_F(Sensors, RefusesFilesOfSomethingElse) {
  EXPECT_EQ(refusal("type=\"abstract\" spec=\"bad.txt\""),
            "a.xml:2: <tactile spec=\"bad.txt\">: bad.txt:2: found 3 words; a point is x y z, then "
            "its axes a0x a0y a0z and a1x a1y a1z");
  EXPECT_EQ(
      refusal("type=\"abstract\" spec=\"none.txt\""),
      "a.xml:2: <tactile spec=\"none.txt\">: the file has no point; a sensor has at least one");
  EXPECT_EQ(refusal("type=\"abstract\" spec=\"missing.txt\""),
            "a.xml:2: <tactile spec=\"missing.txt\">: " + (folder_ / "missing.txt").string() +
                ": cannot be opened: No such file or directory");
}

}  // namespace
}  // namespace hbar::scene
