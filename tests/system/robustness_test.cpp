// What must not break a simulation, and what a failure leaves behind.

#include <gtest/gtest.h>

#include <limits>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using testing::make_horizon;
using testing::message_of;
using testing::options_of;

/// Swings the stiff pendulum into its limit after some steps.
Inputs swing(const Horizon& horizon) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.1, 0.1;
  inputs.qdot0 << 3.0, -0.5;
  inputs.u.setConstant(0.3);
  return inputs;
}

TEST(Robustness, StiffLimitsAndMotorsConvergeWithTheDefaults) {
  for (const Integrator& integrator : integrators()) {
    for (const bool implicit_motor : {false, true}) {
      Horizon horizon = make_horizon(testing::stiff_pendulum(implicit_motor),
                                     options_of(integrator.name, 0.01, 100));
      const Rollout rollout = simulate(horizon, swing(horizon));
      ASSERT_TRUE(rollout.converged()) << integrator.name << ": " << rollout.report().message;
      const Trajectory& trajectory = rollout.trajectory();
      EXPECT_GT(trajectory.q.row(0).maxCoeff(), 0.2);
      EXPECT_LT(trajectory.q.row(0).maxCoeff(), 0.21);
      EXPECT_EQ(rollout.report().message, "");
      EXPECT_EQ(rollout.report().steps_done, 100);
      EXPECT_NEAR(rollout.report().time, 1.0, 1e-12);
    }
  }
}

TEST(Robustness, AHalvedStepIsRecordedAndEndsAtItsTime) {
  for (const Integrator& integrator : integrators()) {
    SimulationOptions options = options_of(integrator.name, 0.02, 20);
    Horizon whole = make_horizon(testing::double_pendulum(), options);
    const int stages = simulate(whole, whole.nominal_inputs()).trajectory().timeline.stage_count();
    options.newton.max_iter = 4;
    Horizon horizon = make_horizon(testing::stiff_pendulum(false), options);
    const Rollout rollout = simulate(horizon, swing(horizon));
    const Trajectory& trajectory = rollout.trajectory();
    EXPECT_GT(trajectory.timeline.stage_count(), stages) << integrator.name;
    EXPECT_LE(rollout.report().smallest_h, 0.01) << integrator.name;
    EXPECT_EQ(trajectory.step_count(), 20);
    EXPECT_EQ(trajectory.q.cols(), trajectory.timeline.stage_count());
    EXPECT_EQ(static_cast<int>(trajectory.newton.size()), trajectory.timeline.stage_count());
    EXPECT_EQ(static_cast<int>(trajectory.factors.size()), trajectory.timeline.stage_count());
    for (int k = 0; k <= 20; ++k) {
      EXPECT_NEAR(trajectory.timeline.stage(trajectory.timeline.step_end(k)).time, 0.02 * k, 1e-12);
    }
  }
}

TEST(Robustness, AFailureSaysWhereWhyAndWhatToTry) {
  SimulationOptions options = options_of("bdf1", 0.01, 50);
  options.newton.max_iter = 3;
  options.max_halvings = 0;
  Horizon horizon = make_horizon(testing::stiff_pendulum(false), options);
  const Rollout rollout = simulate(horizon, swing(horizon));
  const RolloutReport& report = rollout.report();
  ASSERT_EQ(report.status, RolloutStatus::kStepFailed);
  EXPECT_FALSE(rollout.converged());
  EXPECT_LT(report.steps_done, 50);
  EXPECT_EQ(
      report.message,
      concat("simulation stopped at step ", report.steps_done + 1, " of 50 (t = ", report.time,
             "): iteration limit reached after 3 iterations, |g| = ", report.last_newton.residual,
             " (tol 1e-09), largest correction in coordinate '",
             horizon.model().coordinate_name(report.last_newton.worst),
             "', smallest time step tried 0.01; try a smaller time step, softer springs, "
             "limits, contacts or motor gains, or a larger Newton tolerance"));
}

TEST(Robustness, AFailureKeepsWhatWasReachedAndHandsOutNoTrajectory) {
  SimulationOptions options = options_of("bdf2", 0.01, 50);
  options.newton.max_iter = 3;
  options.max_halvings = 0;
  Horizon horizon = make_horizon(testing::stiff_pendulum(false), options);
  const Inputs inputs = swing(horizon);
  const Rollout rollout = simulate(horizon, inputs);
  const Trajectory& partial = rollout.partial();
  const int done = rollout.report().steps_done;
  ASSERT_GT(done, 0);
  ASSERT_LT(done, 50);
  EXPECT_EQ(partial.step_count(), done);
  EXPECT_EQ(partial.q.cols(), partial.timeline.stage_count());
  EXPECT_EQ(partial.timeline.last_stage(), partial.timeline.step_end(done));
  EXPECT_TRUE(partial.q.allFinite());
  EXPECT_EQ(message_of<NumericalFailure>([&] { static_cast<void>(rollout.trajectory()); }),
            rollout.report().message);
  EXPECT_EQ(message_of<NumericalFailure>(
                [&] { static_cast<void>(simulate(horizon, inputs).trajectory()); }),
            rollout.report().message);
  // What was reached is what a shorter simulation gives.
  options.steps = done;
  Horizon shorter = make_horizon(testing::stiff_pendulum(false), options);
  Inputs short_inputs = inputs;
  short_inputs.u = inputs.u.leftCols(done);
  EXPECT_EQ(simulate(shorter, short_inputs).trajectory().q, partial.q);
}

TEST(Robustness, HalvesNoMoreOftenThanAllowed) {
  for (const int halvings : {0, 1, 4}) {
    SimulationOptions options = options_of("sdirk2", 0.01, 5);
    options.newton.max_iter = 1;  // never enough
    options.max_halvings = halvings;
    Horizon horizon = make_horizon(testing::double_pendulum(), options);
    const Rollout rollout = simulate(horizon, horizon.nominal_inputs());
    EXPECT_EQ(rollout.report().status, RolloutStatus::kStepFailed);
    EXPECT_EQ(rollout.report().smallest_h, std::ldexp(0.01, -halvings));
    EXPECT_EQ(rollout.report().steps_done, 0);
    EXPECT_EQ(rollout.partial().q.cols(), 1);
  }
}

TEST(Robustness, AFailureLeavesTheSimulatorAsItWas) {
  SimulationOptions options = options_of("bdf2", 0.01, 30);
  options.newton.max_iter = 3;
  options.max_halvings = 0;
  const Model model = testing::stiff_pendulum(false);
  const Horizon horizon = make_horizon(model, options);
  Simulator used(horizon);
  ASSERT_FALSE(used.rollout(swing(horizon)).converged());
  const Inputs gentle = horizon.nominal_inputs();
  EXPECT_EQ(used.rollout(gentle).trajectory().q, simulate(horizon, gentle).trajectory().q);
}

TEST(Robustness, AbsurdInputsEndInAFailureThatIsSaid) {
  for (const double speed : {1e30, 1e160, 1e308}) {
    Horizon horizon = make_horizon(testing::double_pendulum(), options_of("bdf2", 0.01, 3));
    Inputs inputs = horizon.nominal_inputs();
    inputs.qdot0 << speed, -speed;
    const Rollout rollout = simulate(horizon, inputs);
    if (rollout.converged()) {
      EXPECT_TRUE(rollout.trajectory().q.allFinite()) << speed;
      EXPECT_TRUE(rollout.trajectory().qdot.allFinite()) << speed;
    } else {
      EXPECT_EQ(rollout.report().status, RolloutStatus::kStepFailed);
      EXPECT_NE(rollout.report().message, "");
    }
  }
}

TEST(Robustness, MassesMayDifferByEightDecades) {
  for (const double mass : {1e-4, 1e4}) {
    ModelBuilder builder = testing::double_pendulum_builder();
    Joint joint{.name = "wrist", .kind = RevoluteJoint{Eigen::Vector3d::UnitX()}};
    joint.X_PJ.p = {0.0, 0.0, -0.6};
    builder.add_link(
        1, joint,
        testing::body_at({0.0, 0.0, -0.1}, mass, mass * Eigen::Vector3d(.1, .1, .1), "hand"));
    Horizon horizon = make_horizon(builder.build(), options_of("bdf2", 0.005, 100));
    Inputs inputs = horizon.nominal_inputs();
    inputs.q0 << 0.5, 0.5, 0.5;
    const Rollout rollout = simulate(horizon, inputs);
    ASSERT_TRUE(rollout.converged()) << mass << ": " << rollout.report().message;
    AdjointSweep sweep(horizon);
    const Gradient g = sweep.gradient(rollout.trajectory(), Objective(squared_variables()));
    EXPECT_TRUE(g.p.allFinite());
    EXPECT_LT(sweep.worst_residual(), 1e-13) << mass;
  }
}

TEST(Robustness, AUsersExceptionLeavesTheSweepUsable) {
  Horizon horizon = make_horizon(testing::double_pendulum(), options_of("bdf1", 0.01, 10));
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.3, 0.2;
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  AdjointSweep sweep(horizon);
  const Objective good(squared_variables());
  const Gradient before = sweep.gradient(trajectory, good);
  const Objective bad(user_term(
      "bad", [](const TrajectoryValues&) { return 0.0; },
      [](const TrajectoryValues&, TrajectoryPartials&) { throw std::runtime_error("mine"); }));
  EXPECT_EQ(
      message_of<std::runtime_error>([&] { static_cast<void>(sweep.gradient(trajectory, bad)); }),
      "mine");
  EXPECT_EQ(sweep.gradient(trajectory, good).p, before.p);
}

}  // namespace
}  // namespace hbar
