#include "hbar/core/model_builder.h"

#include <gtest/gtest.h>

#include <ctime>
#include <functional>

#include "hbar/core/error.h"
#include "tests/core/random_model.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

using testing::message_of;

const double kNan = std::nan("");
const double kInfinity = std::numeric_limits<double>::infinity();

Body brick(const std::string& name = "b") { return solid_body(name, Cuboid{{1.0, 2.0, 3.0}}, 1.0); }

Joint hinge(const std::string& name = "j") { return {.name = name, .kind = RevoluteJoint{}}; }

/// A builder with a hinged link "l" (joint "j", body "b") and a fixed one ("l2", "j2", "b2").
ModelBuilder two_links() {
  ModelBuilder builder("two");
  builder.add_link(-1, hinge(), brick(), "l");
  builder.add_link(0, {.name = "j2"}, brick("b2"), "l2");
  return builder;
}

struct Refusal {
  std::function<void(ModelBuilder&)> call;
  std::string message;
};

/// Adds a third link whose joint was changed.
Refusal bad_joint(const std::function<void(Joint&)>& change, const std::string& message) {
  return {[change](ModelBuilder& builder) {
            Joint joint = hinge("k");
            change(joint);
            builder.add_link(1, joint, brick("c"));
          },
          "joint 'k': " + message};
}

/// Adds a third link whose body was changed.
Refusal bad_body(const std::function<void(Body&)>& change, const std::string& message) {
  return {[change](ModelBuilder& builder) {
            Body body = brick("c");
            change(body);
            builder.add_link(1, hinge("k"), body);
          },
          "body 'c': " + message};
}

Refusal bad_motor(const Motor& motor, const std::string& message) {
  return {[motor](ModelBuilder& builder) { builder.add_motor(motor); }, message};
}

void expect_refusals(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    ModelBuilder builder = two_links();
    const Model before = builder.build();
    EXPECT_EQ(message_of<InvalidInput>([&] { refusal.call(builder); }), refusal.message);
    EXPECT_TRUE(builder.build() == before) << "changed by a call that was refused";
  }
}

TEST(ModelBuilder, RefusesJointsThatCannotBe) {
  expect_refusals({
      bad_joint([](Joint& j) { j.kind = RevoluteJoint{Eigen::Vector3d::Zero()}; },
                "axis is (0 0 0); it must be a non-zero vector"),
      bad_joint(
          [](Joint& j) {
            j.kind = PrismaticJoint{{0.0, kNan, 1.0}};
          },
          "axis is (  0 nan   1); it must be a non-zero vector"),
      bad_joint(
          [](Joint& j) {
            j.kind = PlanarJoint{{1.0, 0.0, 0.0}, {-2.0, 0.0, 0.0}};
          },
          "axis0 and axis1 are parallel; they must span a plane"),
      bad_joint(
          [](Joint& j) {
            j.kind = UniversalJoint{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
          },
          "axis is (0 0 0); it must be a non-zero vector"),
      bad_joint([](Joint& j) { j.X_PJ.R(0, 0) = 1.001; },
                "X_PJ must be a rotation matrix and a finite position"),
      bad_joint([](Joint& j) { j.X_PJ.R = -Eigen::Matrix3d::Identity(); },
                "X_PJ must be a rotation matrix and a finite position"),
      bad_joint([](Joint& j) { j.X_PJ.p.x() = kInfinity; },
                "X_PJ must be a rotation matrix and a finite position"),
      bad_joint([](Joint& j) { j.damping = -1.0; }, "damping is -1; it must be ≥ 0"),
      bad_joint([](Joint& j) { j.damping = kNan; }, "damping is nan; it must be ≥ 0"),
      bad_joint([](Joint& j) { j.stiffness = -2.0; }, "stiffness is -2; it must be ≥ 0"),
      bad_joint([](Joint& j) { j.stiffness = kInfinity; }, "stiffness is inf; it must be ≥ 0"),
      bad_joint([](Joint& j) { j.rest = Eigen::VectorXd::Zero(2); },
                "rest has 2 entries; it must have 1 finite ones"),
      bad_joint([](Joint& j) { j.rest = Eigen::VectorXd::Constant(1, kNan); },
                "rest has 1 entries; it must have 1 finite ones"),
      bad_joint(
          [](Joint& j) {
            j.limits = JointLimits{1.0, -1.0, 0.0};
          },
          "limits are [1, -1]; the lower must not exceed the upper"),
      bad_joint(
          [](Joint& j) {
            j.limits = JointLimits{kNan, 1.0, 0.0};
          },
          "limits are [nan, 1]; the lower must not exceed the upper"),
      bad_joint(
          [](Joint& j) {
            j.limits = JointLimits{-1.0, 1.0, -3.0};
          },
          "limit stiffness is -3; it must be ≥ 0"),
  });
}

TEST(ModelBuilder, RefusesBodiesThatCannotBe) {
  expect_refusals({
      bad_body([](Body& b) { b.X_JB.R.setZero(); },
               "X_JB must be a rotation matrix and a finite position"),
      bad_body([](Body& b) { b.X_JB.p.z() = kNan; },
               "X_JB must be a rotation matrix and a finite position"),
      bad_body([](Body& b) { b.mass = 0.0; }, "mass is 0; it must be positive"),
      bad_body([](Body& b) { b.mass = kNan; }, "mass is nan; it must be positive"),
      bad_body([](Body& b) { b.mass = kInfinity; }, "mass is inf; it must be positive"),
      bad_body(
          [](Body& b) {
            b.inertia = {1.0, 0.0, 1.0};
          },
          "principal moments are (1 0 1); they must be positive"),
      bad_body(
          [](Body& b) {
            b.inertia = {1.0, kNan, 1.0};
          },
          "principal moments are (  1 nan   1); they must be positive"),
      bad_body(
          [](Body& b) {
            b.inertia = {1.0, 1.0, 2.5};
          },
          "principal moments are (  1   1 2.5); none may exceed the sum of the other two"),
  });
}

TEST(ModelBuilder, RefusesLinksThatDoNotFitIn) {
  expect_refusals({
      {[](ModelBuilder& b) { b.add_link(-1, hinge(""), brick("")); },
       "add_link: the link, its joint or its body must have a name"},
      {[](ModelBuilder& b) { b.add_link(2, hinge("k"), brick("c"), "n"); },
       "link 'n', parent: link 2 does not exist; the model has 2 links"},
      {[](ModelBuilder& b) { b.add_link(-2, hinge("k"), brick("c"), "n"); },
       "link 'n', parent: link -2 does not exist; the model has 2 links"},
      {[](ModelBuilder& b) { b.add_link(0, hinge("k"), brick("c"), "l"); },
       "link 'l': this name is taken"},
      {[](ModelBuilder& b) { b.add_link(0, hinge("j"), brick("c"), "n"); },
       "joint 'j': this name is taken"},
      {[](ModelBuilder& b) { b.add_link(0, hinge("k"), brick("b2"), "n"); },
       "body 'b2': this name is taken"},
      {[](ModelBuilder& b) { b.add_link(0, hinge("k"), brick("c"), "n", 64); },
       "link 'n': design mask is 64; it must be a sum of 1, 2, 4, 8, 16, 32"},
      {[](ModelBuilder& b) {
         b.set_gravity({0.0, kNan, 0.0});
       },
       "gravity must be finite"},
      {[](ModelBuilder& b) { b.add_end_effector({.name = "", .link = 7}); },
       "end effector: link 7 does not exist; the model has 2 links"},
      {[](ModelBuilder& b) {
         b.add_end_effector({.name = "e", .link = 0, .position = {kNan, 0.0, 0.0}});
       },
       "end effector 'e': position must be finite"},
      {[](ModelBuilder& b) { static_cast<void>(b.rest_pose(-1)); },
       "rest_pose: link -1 does not exist; the model has 2 links"},
  });
}

TEST(ModelBuilder, RefusesMotorsThatCannotDrive) {
  const std::string where = "motor on joint 'j': ";
  expect_refusals({
      bad_motor({.link = 2}, "motor: link 2 does not exist; the model has 2 links"),
      bad_motor({.link = 1}, "motor on joint 'j2': a fixed joint has no coordinate to drive"),
      bad_motor({.link = 0, .lower = 1.0, .upper = -1.0},
                where + "range is [1, -1]; the lower must not exceed the upper"),
      bad_motor({.link = 0, .lower = kNan},
                where + "range is [nan, inf]; the lower must not exceed the upper"),
      bad_motor({.link = 0, .lower = 1.0}, where + "a range must have both ends or none"),
      bad_motor({.link = 0, .lower = kInfinity}, where + "a range must have both ends or none"),
      bad_motor({.link = 0, .P = -1.0}, where + "P is -1 and D is 0; both must be ≥ 0"),
      bad_motor({.link = 0, .D = kNan}, where + "P is 0 and D is nan; both must be ≥ 0"),
  });
  ModelBuilder builder = two_links();
  builder.add_motor({.link = 0});
  EXPECT_EQ(message_of<InvalidInput>([&] { builder.add_motor({.link = 0}); }),
            where + "this joint has a motor already");
}

TEST(ModelBuilder, RefusesAModelWithoutLinks) {
  EXPECT_EQ(message_of<InvalidInput>([] { static_cast<void>(ModelBuilder("empty").build()); }),
            "model 'empty' has no link");
}

TEST(ModelBuilder, CompletesNamesAxesAndRestPositions) {
  ModelBuilder builder("m");
  builder.add_link(-1, {.name = "", .kind = RevoluteJoint{{0.0, 3.0, 4.0}}}, brick("only"));
  builder.add_link(0, {.name = "knee", .kind = PlanarJoint{{2.0, 0.0, 0.0}, {0.0, 5.0, 0.0}}},
                   brick(""));
  builder.add_end_effector({.name = "", .link = 1});
  const Model model = builder.build();
  EXPECT_EQ(model.link(0).name, "only");
  EXPECT_EQ(model.link(0).joint.name, "only");
  EXPECT_EQ(model.link(1).name, "knee");
  EXPECT_EQ(model.link(1).body.name, "knee");
  EXPECT_EQ(std::get<RevoluteJoint>(model.link(0).joint.kind).axis, Eigen::Vector3d(0.0, 0.6, 0.8));
  EXPECT_EQ(std::get<PlanarJoint>(model.link(1).joint.kind).axis1, Eigen::Vector3d::UnitY());
  EXPECT_EQ(model.link(1).joint.rest, Eigen::VectorXd::Zero(2));
  EXPECT_EQ(model.end_effectors()[0].name, "endeffector0");
}

TEST(ModelBuilder, RestPoseIsTheProductOfThePathsRestFrames) {
  testing::Random random(1);
  ModelBuilder builder("m");
  RigidTransform<double> X_0J;
  for (int i = 0; i < 4; ++i) {
    Joint joint = hinge(concat("j", i));
    joint.X_PJ = testing::random_pose(random);
    builder.add_link(i - 1, joint, brick(concat("b", i)));
    X_0J = X_0J * joint.X_PJ;
    EXPECT_LT(testing::relative_gap(builder.rest_pose(i).R, X_0J.R), 1e-14);
    EXPECT_LT(testing::relative_gap(builder.rest_pose(i).p, X_0J.p), 1e-14);
  }
}

TEST(ModelBuilder, BuildsAChainOfThirtyThousandLinksWithoutRecursion) {
  // A call per link would need more stack than there is.
  const std::clock_t start = std::clock();
  ModelBuilder builder("long");
  constexpr int kLinks = 30000;
  for (int i = 0; i < kLinks; ++i) {
    builder.add_link(i - 1, hinge(concat("j", i)), brick(concat("b", i)));
  }
  const Model model = builder.build();
  EXPECT_EQ(model.dof(), kLinks);
  EXPECT_EQ(builder.rest_pose(kLinks - 1).R, Eigen::Matrix3d::Identity());
  EXPECT_LT(std::clock() - start, 30 * CLOCKS_PER_SEC);
}

TEST(SolidBody, TakesItsMassFromItsShapeAndDensity) {
  const Body body = solid_body("b", Sphere{2.0}, 3.0);
  const MassProperties properties = solid_mass_properties(Sphere{2.0}, 3.0);
  EXPECT_EQ(body.mass, properties.mass);
  EXPECT_EQ(body.inertia, properties.inertia);
  EXPECT_TRUE(body.shape == Shape(Sphere{2.0}));
}

}  // namespace
}  // namespace hbar
