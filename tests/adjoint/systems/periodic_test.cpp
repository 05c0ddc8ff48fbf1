#include "hbar/adjoint/systems/periodic.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "tests/support/input_vector.h"
#include "tests/support/periodic_problems.h"
#include "tests/support/scenes.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::driven_pendulum;
using testing::flatten;
using testing::input_classes;
using testing::InputClass;
using testing::Random;
using testing::small_problem;
using testing::taylor_slope;
using testing::unflatten;

class PeriodicOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(PeriodicOfEveryIntegrator, IsAPeriodicSimulation) {
  Problem problem = driven_pendulum(GetParam(), 25);
  const PeriodicOrbit orbit = solve_periodic(problem.horizon, problem.inputs);
  const Trajectory& found = orbit.trajectory;
  const int last = found.timeline.last_stage();
  EXPECT_EQ(found.q.col(last), found.q.col(0));
  EXPECT_EQ(found.qdot.col(last), found.qdot.col(0));
  EXPECT_GT(orbit.mismatch, 1e-4);  // the simulated periods alone had not closed
  EXPECT_LE(orbit.newton.iterations, 8);
  const Trajectory simulated = simulate(problem.horizon, found.inputs).trajectory();
  EXPECT_LT((simulated.q - found.q).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_LT((simulated.qdot - found.qdot).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST_P(PeriodicOfEveryIntegrator, IsWhereALongSimulationEnds) {
  Problem problem = driven_pendulum(GetParam(), 25);
  const PeriodicOrbit orbit = solve_periodic(problem.horizon, problem.inputs);
  Inputs inputs = problem.inputs;
  for (int period = 0; period < 60; ++period) {
    const Trajectory trajectory = simulate(problem.horizon, inputs).trajectory();
    inputs.q0 = trajectory.q_at_step(25);
    inputs.qdot0 = trajectory.qdot_at_step(25);
  }
  EXPECT_LT((inputs.q0 - orbit.trajectory.inputs.q0).lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_LT((inputs.qdot0 - orbit.trajectory.inputs.qdot0).lpNorm<Eigen::Infinity>(), 1e-7);
}

/// A mass of 2 on a spring with damping, pushed by cos ωt in one period of N steps.
double oscillator_error(const std::string& integrator, int steps) {
  const double omega = 3.0;
  const double mass = 2.0;
  const double stiffness = 30.0;
  const double damping = 1.5;
  ModelBuilder builder("oscillator");
  Joint joint{.name = "slide", .kind = PrismaticJoint{{0.0, 0.0, 1.0}}, .damping = damping};
  joint.stiffness = stiffness;
  const int link = builder.add_link(
      -1, joint,
      testing::body_at(Eigen::Vector3d::Zero(), mass, Eigen::Vector3d::Constant(0.1), "mass"));
  builder.add_motor({.link = link, .kind = Motor::Kind::kForce});
  const double h = 2.0 * std::numbers::pi / omega / steps;
  Horizon horizon(builder.build(), {}, {.integrator = integrator, .h = h, .steps = steps});
  Inputs inputs = horizon.nominal_inputs();
  // A control acts during a whole step: BDF balances forces at its end, SDIRK2 within it.
  for (int k = 0; k < steps; ++k) {
    inputs.u(0, k) = integrator == "sdirk2"
                         ? (std::sin(omega * h * (k + 1)) - std::sin(omega * h * k)) / (omega * h)
                         : std::cos(omega * h * (k + 1));
  }
  const PeriodicOrbit orbit = solve_periodic(horizon, inputs);
  using namespace std::complex_literals;
  const std::complex<double> answer =
      1.0 / (stiffness - mass * omega * omega + 1.0i * damping * omega);
  double worst = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double exact = (answer * std::exp(1.0i * (omega * h * k))).real();
    worst = std::max(worst, std::abs(orbit.trajectory.q_at_step(k)[0] - exact));
  }
  return worst / std::abs(answer);
}

TEST_P(PeriodicOfEveryIntegrator, ConvergesToTheOscillatorsAnswerWithItsOrder) {
  const double order = GetParam() == "bdf1" ? 1.0 : 2.0;
  const double coarse = oscillator_error(GetParam(), 200);
  const double fine = oscillator_error(GetParam(), 400);
  EXPECT_LT(fine, order == 1.0 ? 3e-2 : 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.1);
}

/// Ψ of the orbit near given inputs.
double orbit_value(const Problem& problem, const Inputs& inputs) {
  const PeriodicOrbit orbit = solve_periodic(problem.horizon, inputs);
  return problem.objective.value(read_values(problem.horizon, orbit.trajectory));
}

TEST_P(PeriodicOfEveryIntegrator, HasTheExactGradientByEveryClass) {
  Problem problem = driven_pendulum(GetParam(), 20);
  PeriodicSolver solver(problem.horizon);
  const PeriodicOrbit orbit = solver.solve(problem.inputs);
  const Gradient gradient = solver.gradient(orbit.trajectory, problem.objective);
  EXPECT_EQ(gradient.q0, Eigen::VectorXd::Zero(2));
  EXPECT_EQ(gradient.qdot0, Eigen::VectorXd::Zero(2));
  problem.inputs.q0 = orbit.trajectory.inputs.q0;
  problem.inputs.qdot0 = orbit.trajectory.inputs.qdot0;
  const Eigen::VectorXd x = flatten(problem.inputs);
  int classes = 0;
  for (const InputClass& entries : input_classes(problem.horizon, problem.inputs)) {
    if (entries.name == "q0" || entries.name == "qdot0") {
      continue;
    }
    ++classes;
    Random random(5);
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(x.size());
    direction(entries.entries) = random.vector(static_cast<Eigen::Index>(entries.entries.size()));
    const double slope = flatten(gradient).dot(direction);
    const auto psi = [&](double e) {
      return orbit_value(problem, unflatten(x + e * direction, problem.inputs));
    };
    const double e = 1e-4;
    const double quotient = (8.0 * (psi(0.5 * e) - psi(-0.5 * e)) - (psi(e) - psi(-e))) / (6.0 * e);
    EXPECT_NEAR(slope, quotient, 1e-6 * std::max(1e-3, std::abs(quotient))) << entries.name;
  }
  EXPECT_GE(classes, 9);
}

/// dΨ along a direction of p and u by another route: tangents of one simulated period, and the
/// initial state that follows from its monodromy matrix, w = Φ w + s.
double derivative_by_monodromy(const Problem& problem, const Trajectory& orbit,
                               const Eigen::VectorXd& dp, const Eigen::VectorXd& du) {
  const Horizon& horizon = problem.horizon;
  const int n = horizon.model().dof();
  Directions d = Directions::zero(horizon, 2 * n + 1);
  d.q0.leftCols(n).setIdentity();
  d.qdot0.middleCols(n, n).setIdentity();
  d.p.col(2 * n) = dp;
  d.u.col(2 * n) = du;
  TangentSweep sweep(horizon);
  const Tangents tangents = sweep.push_forward(orbit, d);
  Eigen::MatrixXd end(2 * n, 2 * n + 1);
  end << tangents.q.bottomRows(n), tangents.qdot.bottomRows(n);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const Eigen::VectorXd w = (I - end.leftCols(2 * n)).partialPivLu().solve(end.col(2 * n));
  const TrajectoryPartials partials = problem.objective.partials(read_values(horizon, orbit));
  double out = directional_derivative(partials, tangents, d, 2 * n);
  for (int i = 0; i < 2 * n; ++i) {
    out += w[i] * directional_derivative(partials, tangents, d, i);
  }
  return out;
}

TEST_P(PeriodicOfEveryIntegrator, HasTheTangentsDerivativeThroughTheMonodromyMatrix) {
  for (const bool contact : {false, true}) {
    Problem problem = driven_pendulum(GetParam(), 20, contact);
    PeriodicSolver solver(problem.horizon);
    const Trajectory orbit = solver.solve(problem.inputs).trajectory;
    const Gradient gradient = solver.gradient(orbit, problem.objective);
    Random random(11);
    for (int i = 0; i < 5; ++i) {
      const Eigen::VectorXd dp = random.vector(gradient.p.size());
      const Eigen::VectorXd du = random.vector(gradient.u.size());
      const double expected = derivative_by_monodromy(problem, orbit, dp, du);
      const double scale = gradient.p.norm() * dp.norm() + gradient.u.norm() * du.norm();
      EXPECT_NEAR(gradient.p.dot(dp) + gradient.u.reshaped().dot(du), expected, 1e-12 * scale)
          << contact;
    }
  }
}

TEST_P(PeriodicOfEveryIntegrator, HasTaylorRemaindersOfSecondOrder) {
  Problem problem = driven_pendulum(GetParam(), 20);
  PeriodicSolver solver(problem.horizon);
  const PeriodicOrbit orbit = solver.solve(problem.inputs);
  const Gradient gradient = solver.gradient(orbit.trajectory, problem.objective);
  const Eigen::VectorXd x = flatten(problem.inputs);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(x.size());
  for (const InputClass& entries : input_classes(problem.horizon, problem.inputs)) {
    if (entries.name == "joint_transform" || entries.name == "u") {
      Random random(2);
      direction(entries.entries) = random.vector(static_cast<Eigen::Index>(entries.entries.size()));
    }
  }
  const auto psi = [&](double e) {
    return orbit_value(problem, unflatten(x + e * direction, problem.inputs));
  };
  EXPECT_NEAR(taylor_slope(psi, flatten(gradient).dot(direction), 1e-2), 2.0, 0.1);
}

TEST(Periodic, AnalysesItsPatternOnce) {
  Problem problem = driven_pendulum("bdf2", 20);
  PeriodicSolver solver(problem.horizon);
  for (int i = 0; i < 3; ++i) {
    problem.inputs.u(0, 3) += 0.1;
    const PeriodicOrbit orbit = solver.solve(problem.inputs);
    EXPECT_GT(solver.gradient(orbit.trajectory, problem.objective).value, 0.0);
  }
  EXPECT_EQ(solver.solver().statistics().analyses, 1);
  EXPECT_GE(solver.solver().statistics().factorizations, 9);
  EXPECT_EQ(solver.solver().name(), "klu");
}

TEST(Periodic, FindsARotationThatAdvances) {
  // A pendulum that a steady torque and a small ripple turn once per period against damping.
  ModelBuilder builder("rotor");
  builder.set_gravity({0.0, 0.0, -9.8});
  Joint joint{.name = "axle", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}, .damping = 0.5};
  const int link = builder.add_link(
      -1, joint,
      testing::body_at({0.0, 0.0, -0.05}, 1.0, Eigen::Vector3d::Constant(0.05), "rotor"));
  builder.add_motor({.link = link, .kind = Motor::Kind::kForce});
  const int steps = 40;
  Horizon horizon(builder.build(), {}, {.integrator = "bdf2", .h = 1.0 / steps, .steps = steps});
  Inputs inputs = horizon.nominal_inputs();
  const double turn = 2.0 * std::numbers::pi;
  for (int k = 0; k < steps; ++k) {
    inputs.u(0, k) = 0.5 * turn + 0.4 * std::sin(turn * (k + 1) / steps);
  }
  inputs.qdot0[0] = turn;
  PeriodicOptions options;
  options.warm_up = 8;
  options.advance = Eigen::VectorXd::Constant(1, turn);
  const PeriodicOrbit orbit = solve_periodic(horizon, inputs, options);
  const Trajectory again = simulate(horizon, orbit.trajectory.inputs).trajectory();
  EXPECT_NEAR(again.q_at_step(steps)[0] - again.q_at_step(0)[0], turn, 1e-9);
  EXPECT_NEAR(again.qdot_at_step(steps)[0], again.qdot_at_step(0)[0], 1e-8);
}

TEST(Periodic, NamesTheCoordinateThatNothingHolds) {
  // Free to stand anywhere: every position gives a periodic orbit.
  ModelBuilder builder("free slider");
  Joint joint{.name = "slide", .kind = PrismaticJoint{{0.0, 0.0, 1.0}}, .damping = 1.0};
  builder.add_link(
      -1, joint,
      testing::body_at(Eigen::Vector3d::Zero(), 1.0, Eigen::Vector3d::Constant(0.1), "mass"));
  Horizon horizon(builder.build(), {}, {.integrator = "bdf1", .h = 0.1, .steps = 10});
  Inputs inputs = horizon.nominal_inputs();
  inputs.qdot0[0] = 1.0;
  try {
    (void)solve_periodic(horizon, inputs);
    FAIL() << "a singular system was solved";
  } catch (const NumericalFailure& failure) {
    const std::string message = failure.what();
    EXPECT_NE(message.find("singular"), std::string::npos) << message;
    EXPECT_NE(message.find("coordinate slide"), std::string::npos) << message;
    EXPECT_NE(message.find("stage "), std::string::npos) << message;
  }
}

TEST(Periodic, SaysWhereNewtonsMethodStopped) {
  Problem problem = driven_pendulum("bdf1", 20);
  PeriodicOptions options;
  options.newton.max_iter = 1;
  options.warm_up = 1;
  problem.inputs.q0[0] = 2.5;
  try {
    (void)solve_periodic(problem.horizon, problem.inputs, options);
    FAIL() << "one correction sufficed";
  } catch (const NumericalFailure& failure) {
    const std::string message = failure.what();
    EXPECT_NE(message.find("after 1 iterations"), std::string::npos) << message;
    EXPECT_NE(message.find("warm_up"), std::string::npos) << message;
  }
}

TEST(Periodic, RefusesWrongOptions) {
  Problem problem = driven_pendulum("bdf1", 5);
  PeriodicOptions options;
  options.warm_up = 0;
  EXPECT_THROW(PeriodicSolver(problem.horizon, options), InvalidInput);
  options.warm_up = 1;
  options.advance = Eigen::VectorXd::Zero(3);
  EXPECT_THROW(PeriodicSolver(problem.horizon, options), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, PeriodicOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
