// Contact between two bodies, and what must not change it: action and reaction, stacks, moving
// surfaces, the choice of frame and of units.

#include <gtest/gtest.h>

#include <numbers>

#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/rotation.h"
#include "tests/support/numerics.h"
#include "tests/system/contact_scenes.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::add_free_body;
using testing::ContactProbe;
using testing::ContactRun;
using testing::relative_gap;
using Vector6d = Eigen::Matrix<double, 6, 1>;

class PairOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

/// Two free bodies without gravity: the points of a box against a shape.
Model colliding_pair(const Shape& shape, Reaction reaction) {
  ModelBuilder builder("collision");
  builder.set_gravity(Vector3d::Zero());
  const int box = add_free_body(builder, "box", Cuboid{{0.2, 0.15, 0.1}}, 1000.0);
  const int other = add_free_body(builder, "other", shape, 500.0);
  builder.add_contact({.link = box,
                       .other = other,
                       .coefficients = {.kn = 3e3, .kt = 30.0, .mu = 0.5, .damping = 2e3},
                       .reaction = reaction});
  return builder.build();
}

const std::vector<Shape>& every_shape() {
  static const std::vector<Shape> shapes = {Sphere{0.15}, Cuboid{{0.3, 0.25, 0.2}},
                                            Cylinder{0.12, 0.3}, Capsule{0.1, 0.2}};
  return shapes;
}

/// The box flies, spinning, into the resting other body: 0.3 s in n steps.
ContactRun collide(const Model& model, const std::string& integrator, int n) {
  VectorXd q0(12);
  VectorXd qdot0(12);
  q0 << 0.3, 0.05, -0.02, 0.4, -0.2, 0.3, 0.0, 0.0, 0.0, 0.1, 0.2, -0.3;
  qdot0 << -2.0, 0.1, 0.2, 1.0, -2.0, 1.5, 0.0, 0.0, 0.0, 0.5, 0.0, -0.5;
  return {model, integrator, 0.3 / n, n, q0, qdot0};
}

TEST_P(PairOfEveryIntegrator, KeepsLinearMomentumAndTheSumOfAllWrenchesZero) {
  for (const Shape& shape : every_shape()) {
    const Model model = colliding_pair(shape, Reaction::kPoint);
    const ContactRun run = collide(model, GetParam(), 150);
    ContactProbe probe(model);
    probe.at(run.trajectory.q_at_step(0), run.trajectory.qdot_at_step(0));
    const Vector3d start = probe.momentum().tail<3>();
    int touching = 0;
    for (int step = 1; step <= 150; ++step) {
      const auto& forces =
          probe.at(run.trajectory.q_at_step(step), run.trajectory.qdot_at_step(step));
      EXPECT_LT((probe.momentum().tail<3>() - start).norm(), 1e-12 * start.norm()) << step;
      // Both about the world's origin: force and moment.
      const Vector6d sum = forces.wrenches()[0] + forces.wrenches()[1];
      EXPECT_LE(sum.norm(), 1e-12 * forces.wrenches()[0].norm()) << step;
      touching += forces.active().empty() ? 0 : 1;
    }
    EXPECT_GT(touching, 5) << shape.index();
  }
}

TEST_P(PairOfEveryIntegrator, LosesAngularMomentumWithItsOrderAsItDoesWithoutContact) {
  // Spinning bodies lose some to every method; a contact that did not act equally on both would
  // leave a loss that does not vanish with h.
  const Model model = colliding_pair(Sphere{0.15}, Reaction::kPoint);
  ContactProbe probe(model);
  const auto loss = [&](int n) {
    const ContactRun run = collide(model, GetParam(), n);
    probe.at(run.trajectory.q_at_step(0), run.trajectory.qdot_at_step(0));
    const Vector3d start = probe.momentum().head<3>();
    probe.at(run.q_end(), run.qdot_end());
    return (probe.momentum().head<3>() - start).norm() / start.norm();
  };
  const int order = find_integrator(GetParam()).order;
  const double fine = loss(4800);
  EXPECT_LT(fine, order == 1 ? 3e-3 : 3e-5);
  EXPECT_GT(std::log2(loss(2400) / fine), order - 0.3);
}

TEST_P(PairOfEveryIntegrator, KeepsLinearMomentumWhereTheOtherBodyReactsAtItsSurface) {
  const Model model = colliding_pair(Cuboid{{0.3, 0.25, 0.2}}, Reaction::kSurface);
  const ContactRun run = collide(model, GetParam(), 150);
  ContactProbe probe(model);
  probe.at(run.trajectory.q_at_step(0), run.trajectory.qdot_at_step(0));
  const Vector3d start = probe.momentum().tail<3>();
  probe.at(run.q_end(), run.qdot_end());
  EXPECT_LT((probe.momentum().tail<3>() - start).norm(), 1e-12 * start.norm());
}

TEST_P(PairOfEveryIntegrator, StacksTwoBoxes) {
  ModelBuilder builder("stack");
  builder.set_gravity({0.0, 0.0, -9.81});
  const int lower = add_free_body(builder, "lower", Cuboid{{0.3, 0.3, 0.1}}, 1000.0);
  const int upper = add_free_body(builder, "upper", Cuboid{{0.2, 0.2, 0.1}}, 1000.0);
  const ContactCoefficients k{.kn = 1e4, .kt = 50.0, .mu = 0.5, .damping = 1e5};
  builder.add_contact({.link = lower, .surface = Plane{}, .coefficients = k, .adhesion = false});
  builder.add_contact({.link = upper, .other = lower, .coefficients = k, .adhesion = false});
  const Model model = builder.build();
  VectorXd q0 = VectorXd::Zero(12);
  q0[2] = 0.052;  // 2 mm above the ground
  q0[8] = 0.155;  // 3 mm above the lower one
  q0[11] = 0.2;   // turned
  ContactRun run(model, GetParam(), 0.005, 600, q0, VectorXd::Zero(12));
  const auto rest = contact_history(run.horizon, run.trajectory).back();
  EXPECT_EQ(rest[0].active, 4);
  EXPECT_EQ(rest[1].active, 4);
  EXPECT_NEAR(rest[0].normal_force, 13.0 * 9.81, 1e-6 * 13.0 * 9.81);
  EXPECT_NEAR(rest[1].normal_force, 4.0 * 9.81, 1e-6 * 4.0 * 9.81);
  EXPECT_NEAR(rest[0].penetration, 13.0 * 9.81 / (4.0 * k.kn), 1e-8);
  EXPECT_NEAR(rest[1].penetration, 4.0 * 9.81 / (4.0 * k.kn), 1e-8);
  EXPECT_LT(run.qdot_end().norm(), 1e-6);
}

/// A rider on a platform that slides along x, as a cuboid, a capsule or a cylinder along x; under
/// gravity.
Model platform_and_rider(const Shape& platform, const Shape& rider, double platform_density) {
  ModelBuilder builder("platform");
  builder.set_gravity({0.0, 0.0, -9.81});
  Body body = testing::touching_body("platform", platform, platform_density);
  if (!std::holds_alternative<Cuboid>(platform)) {
    body.X_JB.R = exp_rotation<double>(Vector3d(0.0, 0.5 * std::numbers::pi, 0.0));
  }
  const int base =
      builder.add_link(-1, Joint{.name = "rail", .kind = PrismaticJoint{Vector3d::UnitX()}}, body);
  const int top = add_free_body(builder, "rider", rider, 500.0);
  builder.add_contact({.link = top,
                       .other = base,
                       .coefficients = {.kn = 2e4, .kt = 200.0, .mu = 0.4, .damping = 1e5},
                       .adhesion = false});
  return builder.build();
}

TEST_P(PairOfEveryIntegrator, DoesNotDependOnAMotionThatBothShare) {
  const double speed = 1.3;
  for (const Shape& platform :
       {Shape(Cuboid{{1.0, 0.3, 0.2}}), Shape(Capsule{0.1, 0.6}), Shape(Cylinder{0.1, 0.8})}) {
    for (const Shape& rider : {Shape(Sphere{0.05}), Shape(Cuboid{{0.1, 0.1, 0.06}})}) {
      const Model model = platform_and_rider(platform, rider, 800.0);
      VectorXd q0 = VectorXd::Zero(7);
      VectorXd qdot0 = VectorXd::Zero(7);
      q0[3] = 0.155;
      q0.tail<3>() << 0.1, 0.2, -0.1;
      qdot0 << 0.0, 0.4, 0.02, -0.1, 0.0, 1.0, 0.5;
      const ContactRun still(model, GetParam(), 0.002, 150, q0, qdot0);
      qdot0[0] += speed;
      qdot0[1] += speed;
      ContactRun moving(model, GetParam(), 0.002, 150, q0, qdot0);
      int touching = 0;
      for (const auto& step : contact_history(moving.horizon, moving.trajectory)) {
        touching += step[0].active > 0 ? 1 : 0;
      }
      EXPECT_GT(touching, 10);
      for (int step = 0; step <= 150; ++step) {
        VectorXd expected = still.trajectory.q_at_step(step);
        expected.head<2>().array() += 0.002 * step * speed;
        EXPECT_LT((moving.trajectory.q_at_step(step) - expected).norm(), 1e-8)
            << platform.index() << ' ' << rider.index() << ' ' << step;
      }
    }
  }
}

TEST_P(PairOfEveryIntegrator, CarriesARiderAlongUntilBothMoveAlike) {
  const Model model = platform_and_rider(Cuboid{{2.0, 0.4, 0.2}}, Cuboid{{0.2, 0.2, 0.1}}, 50.0);
  const double M = model.link(0).body.mass;
  const double m = model.link(1).body.mass;
  VectorXd q0 = VectorXd::Zero(7);
  q0[3] = 0.15 - m * 9.81 / (4.0 * 2e4);
  VectorXd qdot0 = VectorXd::Zero(7);
  qdot0[0] = 1.0;
  const ContactRun run(model, GetParam(), 0.005, 500, q0, qdot0);
  EXPECT_NEAR(run.qdot_end()[0], M / (M + m), 1e-9);
  EXPECT_NEAR(run.qdot_end()[1], M / (M + m), 1e-9);
}

/// A tumbling box above a plane through the origin, in a world turned by R and moved by p.
Model turned_ground(const RigidTransform<double>& X, double L, double M, Units units) {
  ModelBuilder builder("turned", units);
  builder.set_gravity(X.R * Vector3d(0.5, 0.0, -9.81) * L);
  const Shape shape = Cuboid{L * Vector3d(0.2, 0.15, 0.1)};
  Joint joint{.name = "free", .kind = Free3dExpJoint{}, .X_PJ = X};
  const int body =
      builder.add_link(-1, joint, testing::touching_body("box", shape, 1000.0 * M / (L * L * L)));
  const ContactCoefficients k{.kn = 5e3 * M, .kt = 50.0 * M, .mu = 0.4, .damping = 3e3 * M / L};
  builder.add_contact(
      {.link = body, .surface = Plane{X.p, X.R.col(2)}, .coefficients = k, .adhesion = false});
  return builder.build();
}

/// Its bounce, with lengths in units of 1 / L.
ContactRun bounce(const Model& model, const std::string& integrator, double L) {
  VectorXd q0(6);
  VectorXd qdot0(6);
  q0 << 0.0, 0.0, 0.15 * L, 0.3, -0.2, 0.4;
  qdot0 << 0.5 * L, -0.3 * L, -1.0 * L, 2.0, -1.0, 1.0;
  return {model, integrator, 0.005, 60, q0, qdot0};
}

TEST_P(PairOfEveryIntegrator, DoesNotDependOnThePlanesPlaceAndDirection) {
  const ContactRun level =
      bounce(turned_ground({}, 1.0, 1.0, Units::kMetreKilogram), GetParam(), 1.0);
  for (const Vector3d& r : {Vector3d(0.5, -1.0, 2.0), Vector3d(0.0, std::numbers::pi, 0.0)}) {
    const RigidTransform<double> X{exp_rotation<double>(r), {3.0, -2.0, 1.0}};
    const ContactRun turned =
        bounce(turned_ground(X, 1.0, 1.0, Units::kMetreKilogram), GetParam(), 1.0);
    EXPECT_LT(relative_gap(turned.trajectory.q, level.trajectory.q), 1e-9);
    EXPECT_LT(relative_gap(turned.trajectory.qdot, level.trajectory.qdot), 1e-9);
  }
}

TEST_P(PairOfEveryIntegrator, DoesNotDependOnTheUnits) {
  const ContactRun metres =
      bounce(turned_ground({}, 1.0, 1.0, Units::kMetreKilogram), GetParam(), 1.0);
  const ContactRun centimetres =
      bounce(turned_ground({}, 100.0, 1000.0, Units::kCentimetreGram), GetParam(), 100.0);
  VectorXd unit(6);
  unit << 0.01, 0.01, 0.01, 1.0, 1.0, 1.0;
  EXPECT_LT(relative_gap(unit.asDiagonal() * centimetres.trajectory.q, metres.trajectory.q), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, PairOfEveryIntegrator, ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

}  // namespace
}  // namespace hbar
