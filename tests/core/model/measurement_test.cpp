#include "hbar/core/model/measurement.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using testing::kInfinity;
using testing::kNan;

/// A ball on a joint of three coordinates, a body without a shape, a contact and two motors.
Model measured_model() {
  ModelBuilder builder("measured");
  Body ball = solid_body("ball", Sphere{0.5}, 1.0);
  const int link = builder.add_link(-1, {.name = "place", .kind = TranslationalJoint{}}, ball);
  Body bare = testing::brick("bare");
  bare.shape = NoShape{};
  const int arm = builder.add_link(-1, {.name = "hinge", .kind = RevoluteJoint{}}, bare);
  builder.add_motor({.link = link});
  builder.add_motor({.link = arm});
  builder.add_contact({.name = "ground", .link = link, .surface = Plane{}});
  return builder.build();
}

TEST(RowNames, AreTheMeasurementsOwnWithTheirComponents) {
  const Model model = measured_model();
  using Names = std::vector<std::string>;
  const Names three = {"m.x", "m.y", "m.z"};
  EXPECT_EQ(row_names(model, PointVelocity{"m"}), three);
  EXPECT_EQ(row_names(model, Orientation{"m"}), three);
  EXPECT_EQ(row_names(model, CentreOfMass{"m"}), three);
  EXPECT_EQ(row_names(model, LinearMomentum{"m"}), three);
  EXPECT_EQ(row_names(model, BodyDistance{"m"}), Names{"m"});
  EXPECT_EQ(row_names(model, MotorPower{"m", 0}), Names{"m"});
  EXPECT_EQ(row_names(model, ContactForce{"m"}), (Names{"m.normal", "m.x", "m.y", "m.z"}));
  EXPECT_EQ(row_names(model, MotorTorque{"m", 0}), three);
  EXPECT_EQ(row_names(model, MotorTorque{"m", 1}), Names{"m"});
}

TEST(CheckMeasurements, AcceptsWhatAModelHas) {
  const Model model = measured_model();
  EXPECT_NO_THROW(check_measurements(
      model, {PointVelocity{"speed", 1}, BodyDistance{"gap", 1, Vector3d::Zero(), 0.1, 0},
              BodyDistance{"height", 0, Vector3d::Zero(), 0.0, -1, Plane{}},
              ContactForce{"push", model.find_contact("ground")}, MotorTorque{"torque", 1}}));
}

TEST(CheckMeasurements, RefusesWithTheNameWhatWasFoundAndWhatIsAllowed) {
  struct Case {
    std::vector<Measurement> measurements;
    std::string message;
  };
  const Vector3d origin = Vector3d::Zero();
  const std::shared_ptr<const DistanceField> missing;
  const auto field =
      std::make_shared<const testing::QuadricField>(Eigen::Matrix3d::Identity(), 1.0);
  const std::vector<Case> cases = {
      {{PointVelocity{""}}, "measurement 0 has no name; each must have one"},
      {{PointVelocity{"m", 2}}, "measurement 'm': link is 2; it must be 0 … 1"},
      {{PointVelocity{"m", 0, {0.0, kNan, 0.0}}},
       "measurement 'm': point is (0, nan, 0); it must be finite"},
      {{Orientation{"m", -1}}, "measurement 'm': link is -1; it must be 0 … 1"},
      {{Orientation{"m", 0, 2.0 * Eigen::Matrix3d::Identity()}},
       "measurement 'm': R_0T is no rotation; its columns must be orthonormal and right-handed"},
      {{Orientation{"m", 0, -Eigen::Matrix3d::Identity()}},
       "measurement 'm': R_0T is no rotation; its columns must be orthonormal and right-handed"},
      {{BodyDistance{"m", 5}}, "measurement 'm': link is 5; it must be 0 … 1"},
      {{BodyDistance{"m", 1, {kInfinity, 0.0, 0.0}, 0.0, 0}},
       "measurement 'm': point is (inf, 0, 0); it must be finite"},
      {{BodyDistance{"m", 1, origin, -1.0, 0}}, "measurement 'm': radius is -1; it must be ≥ 0"},
      {{BodyDistance{"m", 1, origin, kNan, 0}}, "measurement 'm': radius is nan; it must be ≥ 0"},
      {{BodyDistance{"m", 1, origin, 0.0, 1}},
       "measurement 'm': other is 1, the link itself; it must be another one, or −1"},
      {{BodyDistance{"m", 1, origin, 0.0, 7}}, "measurement 'm': other is 7; it must be 0 … 1"},
      {{BodyDistance{"m", 1}},
       "measurement 'm': other is −1, the world, which has no shape of its own; its surface must "
       "be a plane"},
      {{BodyDistance{"m", 0, origin, 0.0, 1}},
       "measurement 'm': body 'bare' has no shape; take a plane or a distance field"},
      {{BodyDistance{"m", 0, origin, 0.0, 1, missing}},
       "measurement 'm': the distance field is missing"},
      {{BodyDistance{"m", 0, origin, 0.0, -1, field}},
       "measurement 'm': a distance field needs another body; other is −1"},
      {{BodyDistance{"m", 0, origin, 0.0, -1, Plane{origin, 2.0 * Vector3d::UnitX()}}},
       "measurement 'm': the plane's normal has length 2; it must have length 1"},
      {{BodyDistance{"m", 0, origin, 0.0, -1, Plane{{kNan, 0.0, 0.0}}}},
       "measurement 'm': the plane's point is (nan, 0, 0); it must be finite"},
      {{ContactForce{"m", 1}}, "measurement 'm': contact is 1; it must be 0 … 0"},
      {{MotorTorque{"m", 2}}, "measurement 'm': motor is 2; it must be 0 … 1"},
      {{MotorPower{"m", -1}}, "measurement 'm': motor is -1; it must be 0 … 1"},
      {{CentreOfMass{"m"}, PointVelocity{"m"}},
       "measurement 'm': its row 'm.x' has the name of another; names must differ"},
  };
  const Model model = measured_model();
  for (const Case& wrong : cases) {
    EXPECT_EQ(
        testing::message_of<InvalidInput>([&] { check_measurements(model, wrong.measurements); }),
        wrong.message);
  }
}

TEST(CheckMeasurements, SaysWhereAModelHasNone) {
  ModelBuilder builder("bare");
  builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{}}, testing::brick());
  const Model model = builder.build();
  EXPECT_EQ(
      testing::message_of<InvalidInput>([&] { check_measurements(model, {ContactForce{"m"}}); }),
      "measurement 'm': contact is 0; the model has none");
}

}  // namespace
}  // namespace hbar
