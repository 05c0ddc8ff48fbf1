#include "hbar/core/dynamics/joint_forces.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

/// One coordinate with everything at hand.
struct Slider {
  Joint joint{.name = "slider", .kind = PrismaticJoint{}};
  std::optional<Motor> motor;
  double q = 0.3;
  double qdot = -0.7;
  double u = 0.0;
  double start_q = 0.1;
  double start_qdot = 0.4;

  [[nodiscard]] double force() const {
    ModelBuilder builder("slider");
    builder.add_link(-1, joint, solid_body("body", Sphere{1.0}, 1.0));
    if (motor) {
      builder.add_motor(*motor);
    }
    const Model model = builder.build();
    JointForces<double> forces(model);
    const auto one = [](double x) { return VectorXd(VectorXd::Constant(1, x)); };
    compute_joint_forces<double>(model, nominal_mechanism<double>(model), one(q), one(qdot),
                                 motor ? one(u) : VectorXd(), {one(start_q), one(start_qdot)},
                                 forces);
    return forces.tau[0];
  }
};

TEST(JointForces, AreSpringsAroundTheRestPositionAndDampers) {
  Slider slider;
  slider.joint.stiffness = 3.0;
  slider.joint.rest = VectorXd::Constant(1, 0.5);
  EXPECT_DOUBLE_EQ(slider.force(), -3.0 * (0.3 - 0.5));
  slider.joint.damping = 2.0;
  EXPECT_DOUBLE_EQ(slider.force(), -3.0 * (0.3 - 0.5) - 2.0 * -0.7);
}

TEST(JointForces, PushBackFromOutsideTheLimitsOnly) {
  Slider slider;
  slider.joint.limits = JointLimits{-0.2, 0.4, 10.0};
  EXPECT_EQ(slider.force(), 0.0);
  slider.q = 0.6;
  EXPECT_DOUBLE_EQ(slider.force(), 10.0 * (0.4 - 0.6));
  slider.q = -0.3;
  EXPECT_DOUBLE_EQ(slider.force(), 10.0 * (-0.2 + 0.3));
}

TEST(ForceMotor, MapsItsControlToItsRangeAndClampsIt) {
  Slider slider;
  slider.motor = Motor{.link = 0, .lower = -1.0, .upper = 5.0};
  for (const auto& [u, force] : std::vector<std::pair<double, double>>{
           {-1.0, -1.0}, {0.0, 2.0}, {0.5, 3.5}, {1.0, 5.0}, {1.5, 5.0}, {-9.0, -1.0}}) {
    slider.u = u;
    EXPECT_DOUBLE_EQ(slider.force(), force) << u;
  }
}

TEST(ForceMotor, IsItsControlWithoutARange) {
  Slider slider;
  slider.motor = Motor{.link = 0};
  slider.u = -17.5;
  EXPECT_EQ(slider.force(), -17.5);
}

TEST(PositionMotor, ActsOnTheStateAtTheStepsStartOrAtItsEndAndSaturates) {
  Slider slider;
  slider.motor = Motor{
      .link = 0, .kind = Motor::Kind::kPosition, .lower = -4.0, .upper = 6.0, .P = 5.0, .D = 0.5};
  slider.u = 0.6;
  EXPECT_DOUBLE_EQ(slider.force(), 5.0 * (0.6 - 0.1) - 0.5 * 0.4);
  slider.motor->implicit = true;
  EXPECT_DOUBLE_EQ(slider.force(), 5.0 * (0.6 - 0.3) - 0.5 * -0.7);
  for (const bool implicit : {false, true}) {
    slider.motor->implicit = implicit;
    slider.u = 3.0;
    EXPECT_EQ(slider.force(), 6.0);
    slider.u = -3.0;
    EXPECT_EQ(slider.force(), -4.0);
  }
}

/// Where joint forces are evaluated; each argument a vector that can be displaced.
struct Arguments {
  VectorXd q, qdot, u, start_q, start_qdot, P, D, stiffness, damping;
};

/// τ on duals, with the argument `which` displaced by d.
VectorXd tau_slope(const Model& model, const Arguments& x, VectorXd Arguments::*which,
                   const VectorXd& d) {
  const auto dual = [&](VectorXd Arguments::*argument) -> VectorX<Dual> {
    const VectorXd& value = x.*argument;
    const VectorXd zero = VectorXd::Zero(value.size());
    return testing::with_slope(value, argument == which ? d : zero);
  };
  auto mechanism = nominal_mechanism<Dual>(model);
  mechanism.motor_P = dual(&Arguments::P);
  mechanism.motor_D = dual(&Arguments::D);
  mechanism.stiffness = dual(&Arguments::stiffness);
  mechanism.damping = dual(&Arguments::damping);
  JointForces<Dual> forces(model);
  compute_joint_forces<Dual>(model, mechanism, dual(&Arguments::q), dual(&Arguments::qdot),
                             dual(&Arguments::u),
                             {dual(&Arguments::start_q), dual(&Arguments::start_qdot)}, forces);
  return testing::slopes(forces.tau);
}

class EveryModelsJointForces : public ::testing::TestWithParam<unsigned> {
 protected:
  Arguments random_arguments() {
    const StagePoint<double> at = testing::random_point(model, random);
    const auto mechanism = nominal_mechanism<double>(model);
    return {at.q,
            at.qdot,
            at.u,
            at.start.q,
            at.start.qdot,
            mechanism.motor_P,
            mechanism.motor_D,
            mechanism.stiffness,
            mechanism.damping};
  }
  JointForces<double> forces_at(const Arguments& x) const {
    JointForces<double> forces(model);
    // Leftovers of an earlier evaluation must not show.
    forces.by_u.setConstant(7.0);
    forces.by_start_q.setConstant(7.0);
    compute_joint_forces<double>(model, nominal_mechanism<double>(model), x.q, x.qdot, x.u,
                                 {x.start_q, x.start_qdot}, forces);
    return forces;
  }
  /// Σ over a motor's controls, on their coordinates.
  VectorXd by_motor(const VectorXd& by_control, const VectorXd& d, bool per_motor) const {
    VectorXd out = VectorXd::Zero(model.dof());
    for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
      const int link = model.motors()[static_cast<std::size_t>(m)].link;
      const int count = joint_dof(model.link(link).joint.kind);
      for (int i = model.first_control(m); i < model.first_control(m) + count; ++i) {
        out[coordinate_of_control(model, m, i)] += by_control[i] * d[per_motor ? m : i];
      }
    }
    return out;
  }
  VectorXd by_joint(const VectorXd& by_coordinate, const VectorXd& d) const {
    VectorXd out(model.dof());
    for (int c = 0; c < model.dof(); ++c) {
      out[c] = by_coordinate[c] * d[model.tree().node(model.tree().node_of(c)).link];
    }
    return out;
  }

  const Model model = testing::random_model(GetParam());
  Random random{GetParam()};
};

TEST_P(EveryModelsJointForces, HaveTheDerivativesThatDualsGive) {
  for (int k = 0; k < 20; ++k) {
    const Arguments x = random_arguments();
    const JointForces<double> f = forces_at(x);
    const auto expect = [&](const char* name, VectorXd Arguments::*which, const auto& derivative) {
      const VectorXd d = random.vector((x.*which).size());
      EXPECT_LT(relative_gap(derivative(d), tau_slope(model, x, which, d)), 1e-14) << name;
    };
    const auto diagonal = [](const VectorXd& by) {
      return [&by](const VectorXd& d) -> VectorXd { return by.cwiseProduct(d); };
    };
    expect("q", &Arguments::q, diagonal(f.by_q));
    expect("qdot", &Arguments::qdot, diagonal(f.by_qdot));
    expect("start q", &Arguments::start_q, diagonal(f.by_start_q));
    expect("start qdot", &Arguments::start_qdot, diagonal(f.by_start_qdot));
    expect("u", &Arguments::u, [&](const VectorXd& d) { return by_motor(f.by_u, d, false); });
    expect("P", &Arguments::P, [&](const VectorXd& d) { return by_motor(f.by_P, d, true); });
    expect("D", &Arguments::D, [&](const VectorXd& d) { return by_motor(f.by_D, d, true); });
    expect("stiffness", &Arguments::stiffness,
           [&](const VectorXd& d) { return by_joint(f.by_stiffness, d); });
    expect("damping", &Arguments::damping,
           [&](const VectorXd& d) { return by_joint(f.by_damping, d); });
  }
}

TEST_P(EveryModelsJointForces, HaveTheDerivativeThatDifferencesGive) {
  // The laws are piecewise linear: a small step away from a kink is exact.
  const Arguments x = random_arguments();
  const Eigen::MatrixXd by_q = testing::differences(
      [&](const VectorXd& q) -> VectorXd {
        Arguments moved = x;
        moved.q = q;
        return forces_at(moved).tau;
      },
      x.q, 1e-6);
  const Eigen::MatrixXd expected = forces_at(x).by_q.asDiagonal();
  EXPECT_LT(relative_gap(by_q, expected), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsJointForces, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
