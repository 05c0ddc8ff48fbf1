#include "hbar/core/model/model_builder.h"

#include <gtest/gtest.h>

#include <ctime>
#include <functional>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using testing::brick;
using testing::kInfinity;
using testing::kNan;
using testing::message_of;

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
          "axis is (0 nan 1); it must be a non-zero vector"),
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
          "principal moments are (1 nan 1); they must be positive"),
      bad_body([](Body& b) { b.contact_points = Eigen::Matrix3Xd::Constant(3, 1, kNan); },
               "its contact points must be finite"),
      bad_body(
          [](Body& b) {
            b.inertia = {1.0, 1.0, 2.5};
          },
          "principal moments are (1 1 2.5); none may exceed the sum of the other two, as one "
          "does by 0.2 of it"),
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

/// A body without contact points, or with one at its centre.
Body shaped(const std::string& name, const Shape& shape, bool point) {
  Body body = brick(name);
  body.shape = shape;
  body.contact_points = Eigen::Matrix3Xd::Zero(3, point ? 1 : 0);
  return body;
}

/// Bodies: 0 "box" with a point, 1 "smooth" box without, 2 "ball" without, 3 "lump" of no shape
/// with a point.
ModelBuilder four_bodies() {
  ModelBuilder builder("four");
  builder.add_link(-1, hinge("j0"), shaped("box", Cuboid{}, true));
  builder.add_link(-1, hinge("j1"), shaped("smooth", Cuboid{}, false));
  builder.add_link(-1, hinge("j2"), shaped("ball", Sphere{}, false));
  builder.add_link(-1, hinge("j3"), shaped("lump", NoShape{}, true));
  return builder;
}

std::shared_ptr<const DistanceField> some_field() {
  return std::make_shared<const testing::QuadricField>(Eigen::Matrix3d::Identity(), 1.0);
}

TEST(ModelBuilder, AcceptsContactsThatCanBeAndNamesThem) {
  ModelBuilder builder = four_bodies();
  EXPECT_EQ(builder.add_contact({.link = 0, .surface = Plane{}}), 0);
  EXPECT_EQ(builder.add_contact({.link = 2, .surface = Plane{}}), 1);
  builder.add_contact({.link = 0, .other = 1});
  builder.add_contact({.link = 0, .other = 1, .surface = Plane{}});
  builder.add_contact({.name = "mine", .link = 0, .other = 2});
  builder.add_contact({.link = 0, .other = 3, .surface = some_field()});
  builder.add_contact(
      {.link = 0, .other = 1, .friction_law = FrictionLaw::kSmooth, .friction_width = 0.1});
  const Model model = builder.build();
  std::vector<std::string> names;
  for (const Contact& contact : model.contacts()) {
    names.push_back(contact.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"box-ground", "ball-ground", "box-smooth",
                                             "box-smooth-2", "mine", "box-lump", "box-smooth-3"}));
  EXPECT_EQ(model.contact_count(), 7);
}

TEST(ModelBuilder, RefusesContactsThatCannotBe) {
  const Contact good = {.name = "c", .link = 0, .other = 1};
  const auto changed = [&good](const std::function<void(Contact&)>& change) {
    Contact contact = good;
    change(contact);
    ModelBuilder builder = four_bodies();
    const std::string message = message_of<InvalidInput>([&] { builder.add_contact(contact); });
    EXPECT_EQ(builder.build().contact_count(), message.empty() ? 1 : 0);
    return message;
  };
  EXPECT_EQ(changed([](Contact&) {}), "");
  EXPECT_EQ(changed([](Contact& c) { c.link = 4; }),
            "contact, points: link 4 does not exist; the model has 4 links");
  EXPECT_EQ(changed([](Contact& c) { c.other = -2; }),
            "contact, other body: link -2 does not exist; the model has 4 links");
  EXPECT_EQ(changed([](Contact& c) { c.other = 0; }), "contact 'c': a body cannot touch itself");
  EXPECT_EQ(changed([](Contact& c) { c.other = -1; }),
            "contact 'c': the world touches as a plane only");
  EXPECT_EQ(changed([](Contact& c) {
              c.other = -1;
              c.surface = some_field();
            }),
            "contact 'c': the world touches as a plane only");
  EXPECT_EQ(changed([](Contact& c) { c.surface = std::shared_ptr<const DistanceField>(); }),
            "contact 'c': the distance field is null");
  EXPECT_EQ(changed([](Contact& c) { c.other = 3; }),
            "contact 'c': body 'lump' has no shape of its own; give a plane or a distance field");
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0.0, 0.0, 2.0), Eigen::Vector3d(kNan, 0, 0)}) {
    EXPECT_EQ(changed([&](Contact& c) {
                c.surface = Plane{Eigen::Vector3d::Zero(), normal};
              }),
              "contact 'c': a plane needs a finite point and a normal of length 1");
  }
  EXPECT_EQ(changed([](Contact& c) { c.surface = Plane{Eigen::Vector3d(0.0, kInfinity, 0.0)}; }),
            "contact 'c': a plane needs a finite point and a normal of length 1");
  EXPECT_EQ(changed([](Contact& c) {
              c.link = 1;
              c.other = 0;
            }).substr(0, 51),
            "contact 'c': body 'smooth' has no contact points (s");
  EXPECT_NE(changed([](Contact& c) {
              c.link = 2;
              c.surface = some_field();
            }),
            "");
  EXPECT_EQ(changed([](Contact& c) { c.coefficients.kn = -1.0; }),
            "contact 'c': kn is -1; it must be ≥ 0 and finite");
  EXPECT_EQ(changed([](Contact& c) { c.coefficients.kt = kInfinity; }),
            "contact 'c': kt is inf; it must be ≥ 0 and finite");
  EXPECT_EQ(changed([](Contact& c) { c.coefficients.damping = kNan; }),
            "contact 'c': damping is nan; it must be ≥ 0 and finite");
  EXPECT_EQ(changed([](Contact& c) { c.friction_law = FrictionLaw::kSmooth; }),
            "contact 'c': friction width is 0; the smooth law needs it > 0");
  ModelBuilder builder = four_bodies();
  builder.add_contact(good);
  EXPECT_EQ(message_of<InvalidInput>([&] { builder.add_contact(good); }),
            "contact 'c': this name is taken");
}

TEST(ModelBuilder, AcceptsTactileSensorsThatCanBeAndRefusesOthers) {
  TactileSensor good;
  good.link = 1;
  good.points = Eigen::Matrix3Xd::Zero(3, 2);
  good.axis0 = Eigen::Vector3d::UnitX().replicate(1, 2);
  good.axis1 = Eigen::Vector3d::UnitY().replicate(1, 2);
  const auto changed = [&good](const std::function<void(TactileSensor&)>& change) {
    TactileSensor sensor = good;
    sensor.name = "t";
    change(sensor);
    ModelBuilder builder = four_bodies();
    return message_of<InvalidInput>([&] { builder.add_tactile_sensor(sensor); });
  };
  const std::string where = "tactile sensor 't': ";
  EXPECT_EQ(changed([](TactileSensor&) {}), "");
  EXPECT_EQ(changed([](TactileSensor& t) { t.link = -1; }),
            "tactile sensor: link -1 does not exist; the model has 4 links");
  EXPECT_EQ(changed([](TactileSensor& t) { t.points.resize(3, 0); }),
            where + "it needs points, all finite");
  EXPECT_EQ(changed([](TactileSensor& t) { t.points(1, 1) = kNan; }),
            where + "it needs points, all finite");
  EXPECT_EQ(changed([](TactileSensor& t) { t.axis1 = t.axis1.leftCols(1).eval(); }),
            where + "1 axes for 2 points");
  EXPECT_EQ(changed([](TactileSensor& t) { t.axis0 *= 2.0; }), where + "axes must have length 1");
  EXPECT_EQ(changed([](TactileSensor& t) { t.axis1(0, 1) = kNan; }),
            where + "axes must have length 1");
  EXPECT_EQ(changed([](TactileSensor& t) { t.coefficients.mu = -1.0; }),
            where + "mu is -1; it must be ≥ 0 and finite");
  ModelBuilder builder = four_bodies();
  EXPECT_EQ(builder.add_tactile_sensor(good), 0);
  EXPECT_EQ(builder.add_tactile_sensor(good), 1);
  EXPECT_EQ(builder.build().tactile_sensors()[1].name, "tactile1");
  EXPECT_EQ(builder.build().tactile_count(), 12);
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
