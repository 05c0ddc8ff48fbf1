// The order of convergence of every integrator, of trajectories and of gradients, against motions
// integrated here by a method of their own.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/rotation.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// One step of the classical Runge-Kutta method for ẋ = f(x).
template <typename F>
VectorXd runge_kutta_step(const F& f, const VectorXd& x, double h) {
  const VectorXd k1 = f(x);
  const VectorXd k2 = f(x + 0.5 * h * k1);
  const VectorXd k3 = f(x + 0.5 * h * k2);
  const VectorXd k4 = f(x + h * k3);
  return x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

template <typename F>
VectorXd runge_kutta(const F& f, VectorXd x, double T, int steps) {
  for (int k = 0; k < steps; ++k) {
    x = runge_kutta_step(f, x, T / steps);
  }
  return x;
}

/// (q, q̇) of a model without joint forces after a time T: M q̈ = −bias.
VectorXd reference_state(const Model& model, const Inputs& inputs, double T) {
  const int n = model.dof();
  const auto mechanism = nominal_mechanism<double>(model);
  const auto f = [&](const VectorXd& x) {
    const VectorXd q = x.head(n);
    const VectorXd qdot = x.tail(n);
    const VectorXd bias = testing::inverse_dynamics_at<double>(model, mechanism, q, qdot,
                                                               VectorXd(VectorXd::Zero(n)));
    VectorXd rate(2 * n);
    rate << qdot, -testing::mass_matrix_at<double>(model, mechanism, q).llt().solve(bias);
    return rate;
  };
  VectorXd x(2 * n);
  x << inputs.q0, inputs.qdot0;
  return runge_kutta(f, x, T, 2000);
}

/// Rotation of a free body with principal moments I after a time T: Ṙ = R [ω], Euler's equations.
Matrix3d reference_rotation(const Vector3d& I, const Matrix3d& R0, const Vector3d& omega0,
                            double T) {
  const auto f = [&](const VectorXd& x) {
    const Matrix3d R = x.head(9).reshaped(3, 3);
    const Vector3d omega = x.tail<3>();
    Matrix3d cross;
    cross << 0.0, -omega[2], omega[1], omega[2], 0.0, -omega[0], -omega[1], omega[0], 0.0;
    VectorXd rate(12);
    rate << (R * cross).reshaped(),
        (I.cwiseProduct(omega)).cross(omega).cwiseQuotient(I).reshaped();
    return rate;
  };
  VectorXd x(12);
  x << R0.reshaped(), omega0;
  return runge_kutta(f, x, T, 4000).head(9).reshaped(3, 3);
}

Horizon horizon_until(const Model& model, const Integrator& integrator, double T, int steps,
                      const ParameterSet& set = {}) {
  SimulationOptions options;
  options.integrator = integrator.name;
  options.h = T / steps;
  options.steps = steps;
  options.keep_factors = false;
  return {model, set, options};
}

/// Order observed between n and 2 n steps.
template <typename Error>
double observed_order(const Error& error, int n) {
  return std::log2(error(n) / error(2 * n));
}

/// Steps from which on the orders are within 0.05 of their limits.
int enough_steps(const Integrator& integrator) { return integrator.order == 1 ? 3200 : 400; }

Inputs pendulum_inputs(const Horizon& horizon) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.8, -0.5;
  inputs.qdot0 << 0.6, 1.0;
  return inputs;
}

TEST(EveryMethod, ConvergesWithItsOrderOnADoublePendulum) {
  constexpr double kT = 1.0;
  const Model model = testing::double_pendulum();
  for (const Integrator& integrator : integrators()) {
    Horizon any = horizon_until(model, integrator, kT, 1);
    const VectorXd exact = reference_state(model, pendulum_inputs(any), kT);
    const auto state_at = [&](int n) {
      Horizon horizon = horizon_until(model, integrator, kT, n);
      const Trajectory trajectory = simulate(horizon, pendulum_inputs(horizon)).trajectory();
      VectorXd state(4);
      state << trajectory.q_at_step(n), trajectory.qdot_at_step(n);
      return state;
    };
    const int n = enough_steps(integrator);
    const VectorXd coarse = state_at(n) - exact;
    const VectorXd fine = state_at(2 * n) - exact;
    EXPECT_LT(fine.norm(), 0.05) << integrator.name;
    EXPECT_NEAR(std::log2(coarse.head(2).norm() / fine.head(2).norm()), integrator.order, 0.05)
        << integrator.name << ": positions";
    EXPECT_NEAR(std::log2(coarse.tail(2).norm() / fine.tail(2).norm()), integrator.order, 0.05)
        << integrator.name << ": velocities";
  }
}

/// dΨ/d(p, q₀, q̇₀) of Ψ = ½ ‖v_N − target‖².
VectorXd gradient_at(const Model& model, const ParameterSet& set, const Integrator& integrator,
                     double T, int n, const VectorXd& q0, const VectorXd& qdot0) {
  Horizon horizon = horizon_until(model, integrator, T, n, set);
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 = q0;
  inputs.qdot0 = qdot0;
  const VectorXd target = VectorXd::LinSpaced(model.variable_count(), -1.0, 1.0);
  const Gradient g = gradient(horizon, simulate(horizon, inputs).trajectory(),
                              Objective(testing::final_variables(target)));
  VectorXd out(g.p.size() + g.q0.size() + g.qdot0.size());
  out << g.p, g.q0, g.qdot0;
  return out;
}

TEST(EveryMethod, HasGradientsThatConvergeWithItsOrder) {
  const Model model = testing::double_pendulum();
  const Eigen::Vector2d q0(0.8, -0.5);
  const Eigen::Vector2d qdot0(0.6, 1.0);
  for (const Integrator& integrator : integrators()) {
    const auto error = [&](int n) {
      return (gradient_at(model, ParameterSet::all(model), integrator, 1.0, n, q0, qdot0) -
              gradient_at(model, ParameterSet::all(model), integrator, 1.0, 2 * n, q0, qdot0))
          .norm();
    };
    EXPECT_NEAR(observed_order(error, enough_steps(integrator)), integrator.order, 0.05)
        << integrator.name;
  }
}

/// A body without forces that tumbles about its middle axis, out of its first chart.
struct Tumbling {
  Model model = testing::single_body(SphericalExpJoint{}, Vector3d::Zero());
  double T = 1.0;
  Vector3d r0{0.3, -0.2, 0.4};
  Vector3d omega0{1.0, 6.0, 2.0};
  /// ṙ with J_r(r) ṙ = ω.
  Vector3d rate0 = right_jacobian<double>(r0).inverse() * omega0;
};

TEST(EveryMethod, ConvergesWithItsOrderThroughAChangeOfChart) {
  const Tumbling scene;
  const Matrix3d R = reference_rotation(scene.model.link(0).body.inertia,
                                        exp_rotation<double>(scene.r0), scene.omega0, scene.T);
  const Vector3d exact = R * scene.model.end_effectors()[0].position;
  for (const Integrator& integrator : integrators()) {
    const auto error = [&](int n) {
      Horizon horizon = horizon_until(scene.model, integrator, scene.T, n);
      Inputs inputs = horizon.nominal_inputs();
      inputs.q0 = scene.r0;
      inputs.qdot0 = scene.rate0;
      const Trajectory trajectory = simulate(horizon, inputs).trajectory();
      EXPECT_EQ(trajectory.chart_switches.size(), 1U) << integrator.name;
      return (read_values(horizon, trajectory).v().col(n) - exact).norm();
    };
    const int n = enough_steps(integrator);
    EXPECT_LT(error(n), 0.05) << integrator.name;
    EXPECT_NEAR(observed_order(error, n), integrator.order, 0.05) << integrator.name;
  }
}

TEST(EveryMethod, HasGradientsThatConvergeWithItsOrderThroughAChangeOfChart) {
  const Tumbling scene;
  // Without stiffness and damping: those act on the coordinates, which jump with the chart.
  const ParameterSet set =
      ParameterSet::named(scene.model, {"joint.joint.rotation", "body.body", "gravity"});
  for (const Integrator& integrator : integrators()) {
    const auto error = [&](int n) {
      return (gradient_at(scene.model, set, integrator, scene.T, n, scene.r0, scene.rate0) -
              gradient_at(scene.model, set, integrator, scene.T, 2 * n, scene.r0, scene.rate0))
          .norm();
    };
    EXPECT_NEAR(observed_order(error, enough_steps(integrator)), integrator.order, 0.05)
        << integrator.name;
  }
}

}  // namespace
}  // namespace hbar
