#include "hbar/adjoint/trajectory/simulator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <thread>

#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/chart.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using testing::make_horizon;
using testing::message_of;
using testing::options_of;
using testing::relative_gap;

/// Positions and velocities at the steps' ends of the slider.
Eigen::Matrix2Xd states_of(const Horizon& horizon, double q0, double qdot0, double force = 0.0) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0[0] = q0;
  inputs.qdot0[0] = qdot0;
  inputs.u.setConstant(force);
  const TrajectoryValues values = read_values(horizon, simulate(horizon, inputs).trajectory());
  Eigen::Matrix2Xd states(2, values.q.cols());
  states << values.q, values.qdot;
  return states;
}

TEST(Simulator, FallsAsEachMethodsFormulaSays) {
  constexpr double kH = 0.1;
  constexpr double g = 9.81;
  for (const Integrator& integrator : integrators()) {
    Horizon horizon =
        make_horizon(testing::slider(0.0, testing::kGravity), options_of(integrator.name, kH, 20));
    const Eigen::Matrix2Xd states = states_of(horizon, 2.0, 3.0);
    for (int k = 0; k <= 20; ++k) {
      const double t = kH * k;
      const double lag = integrator.order == 1 ? 0.5 * g * kH * t : 0.0;
      EXPECT_NEAR(states(0, k), 2.0 + 3.0 * t - 0.5 * g * t * t - lag, 1e-12) << integrator.name;
      EXPECT_NEAR(states(1, k), 3.0 - g * t, 1e-12) << integrator.name;
    }
  }
}

TEST(Simulator, AppliesTheControlOfEachStep) {
  Horizon horizon =
      make_horizon(testing::slider(0.0, Eigen::Vector3d::Zero()), options_of("bdf1", 0.5, 3));
  Inputs inputs = horizon.nominal_inputs();
  inputs.u << 2.0, -6.0, 4.0;
  const TrajectoryValues values = read_values(horizon, simulate(horizon, inputs).trajectory());
  const Eigen::RowVector4d expected{0.0, 0.5, -1.0, 0.0};  // sums of h u / m
  EXPECT_LT((values.qdot - expected).norm(), 1e-14);
  EXPECT_EQ(values.u, inputs.u);
  EXPECT_EQ(values.h, 0.5);
}

TEST(Simulator, OscillatesWithEachMethodsAmplificationFactor) {
  constexpr double kH = 0.05;
  const double alpha = 1.0 - std::sqrt(0.5);
  const Matrix2d I = Matrix2d::Identity();
  const Matrix2d hA = kH * Matrix2d{{0.0, 1.0}, {-9.0, 0.0}};  // m = 2, k = 18
  const Matrix2d implicit_euler = (I - hA).inverse();
  const Matrix2d inner = (I - alpha * hA).inverse();
  const Matrix2d sdirk2 = (I + (1.0 - 2.0 * alpha) * hA) * inner * inner;
  for (const Integrator& integrator : integrators()) {
    Horizon horizon = make_horizon(testing::slider(18.0, Eigen::Vector3d::Zero()),
                                   options_of(integrator.name, kH, 60));
    const Eigen::Matrix2Xd states = states_of(horizon, 1.0, -0.5);
    Eigen::Matrix2Xd expected(2, 61);
    expected.col(0) = Vector2d(1.0, -0.5);
    for (int k = 0; k < 60; ++k) {
      if (integrator.name == "bdf1") {
        expected.col(k + 1) = implicit_euler * expected.col(k);
      } else if (integrator.name == "sdirk2" || k == 0) {
        expected.col(k + 1) = sdirk2 * expected.col(k);
      } else {
        expected.col(k + 1) =
            (3.0 * I - 2.0 * hA).inverse() * (4.0 * expected.col(k) - expected.col(k - 1));
      }
    }
    EXPECT_LT(relative_gap(states, expected), 1e-12) << integrator.name;
  }
}

TEST(Simulator, AppliesParameters) {
  const Model model = testing::slider(18.0, Eigen::Vector3d::Zero());
  const Horizon horizon = make_horizon(model, options_of("bdf2", 0.05, 30));
  Simulator simulator(horizon);
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0[0] = 1.0;
  inputs.p[horizon.parameters().find("joint.slide.stiffness")] = 50.0;
  Horizon stiffer =
      make_horizon(testing::slider(50.0, Eigen::Vector3d::Zero()), options_of("bdf2", 0.05, 30));
  Inputs nominal = stiffer.nominal_inputs();
  nominal.q0[0] = 1.0;
  EXPECT_EQ(simulator.rollout(inputs).trajectory().q, simulate(stiffer, nominal).trajectory().q);
  // And takes them back again.
  inputs.p = horizon.parameters().nominal();
  EXPECT_EQ(simulator.rollout(inputs).trajectory().q, simulate(horizon, inputs).trajectory().q);
}

TEST(Simulator, GivesValuesInTheirShapes) {
  const Model model = testing::random_model(31);
  Horizon horizon = make_horizon(model, options_of("bdf2", 0.01, 4));
  testing::Random random(1);
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 = random.vector(model.dof(), 0.3);
  inputs.qdot0 = random.vector(model.dof(), 0.3);
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  const TrajectoryValues values = read_values(horizon, trajectory);
  EXPECT_EQ(values.q.rows(), model.dof());
  EXPECT_EQ(values.q.cols(), 5);
  EXPECT_EQ(values.qdot.cols(), 5);
  EXPECT_EQ(values.v().rows(), model.variable_count());
  EXPECT_EQ(values.v().cols(), 5);
  EXPECT_EQ(values.u.cols(), 4);
  EXPECT_EQ(values.q.col(0), inputs.q0);
  EXPECT_EQ(values.qdot.col(0), inputs.qdot0);
  EXPECT_EQ(values.q.col(3), trajectory.q_at_step(3));
  EXPECT_EQ(values.qdot.col(3), trajectory.qdot_at_step(3));
  int iterations = 0;
  for (int k = 0; k < 4; ++k) {
    iterations += trajectory.newton_iterations(k);
  }
  int of_stages = 0;
  for (std::size_t s = 1; s < trajectory.newton.size(); ++s) {
    of_stages += trajectory.newton[s].iterations;
    EXPECT_TRUE(trajectory.newton[s].converged());
  }
  EXPECT_EQ(iterations, of_stages);
}

TEST(Simulator, RefusesAMassThatIsNotPositive) {
  Horizon horizon =
      make_horizon(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  Inputs inputs = horizon.nominal_inputs();
  inputs.p[horizon.parameters().find("body.mass.mass")] = -1.0;
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(simulate(horizon, inputs)); }),
            "body.mass.mass is -1; it must be positive");
}

TEST(Simulator, StopsBeforeTheNextStepWhenAsked) {
  std::atomic<bool> stop = true;
  SimulationOptions options = options_of("bdf1", 0.1, 5);
  options.stop = &stop;
  Horizon horizon = make_horizon(testing::double_pendulum(), options);
  const Rollout stopped = simulate(horizon, horizon.nominal_inputs());
  EXPECT_FALSE(stopped.converged());
  EXPECT_EQ(stopped.report().status, RolloutStatus::kInterrupted);
  EXPECT_EQ(stopped.report().steps_done, 0);
  EXPECT_EQ(stopped.report().message, "simulation interrupted after 0 of 5 steps");
  EXPECT_EQ(stopped.partial().q.cols(), 1);
  EXPECT_EQ(message_of<Interrupted>([&] { static_cast<void>(stopped.trajectory()); }),
            "simulation interrupted after 0 of 5 steps");
  stop = false;
  EXPECT_TRUE(simulate(horizon, horizon.nominal_inputs()).converged());
}

TEST(Simulator, KeepsWhatItReachedWhenStoppedHalfWay) {
  std::atomic<bool> stop = false;
  SimulationOptions options = options_of("bdf1", 1e-3, 2'000'000);
  options.stop = &stop;
  options.keep_factors = false;
  Horizon horizon = make_horizon(testing::double_pendulum(), options);
  const Inputs inputs = horizon.nominal_inputs();
  const std::jthread interrupt([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    stop = true;
  });
  const Rollout rollout = simulate(horizon, inputs);
  const int done = rollout.report().steps_done;
  EXPECT_EQ(rollout.report().status, RolloutStatus::kInterrupted);
  EXPECT_LT(done, options.steps);
  EXPECT_EQ(rollout.partial().step_count(), done);
  EXPECT_EQ(rollout.partial().q.cols(), done + 1);
  EXPECT_NEAR(rollout.report().time, 1e-3 * done, 1e-9 * (1 + done));
  EXPECT_EQ(read_values(horizon, rollout.partial()).q.cols(), done + 1);
}

TEST(Simulator, ChangesChartBeyondTheLimitAndKeepsTheMotion) {
  for (const Integrator& integrator : integrators()) {
    const Model model = testing::single_body(SphericalExpJoint{}, Eigen::Vector3d::Zero());
    Horizon horizon = make_horizon(model, options_of(integrator.name, 0.01, 200));
    Inputs inputs = horizon.nominal_inputs();
    inputs.qdot0 = Eigen::Vector3d(0.0, 0.0, 9.0);  // about a principal axis
    const Trajectory trajectory = simulate(horizon, inputs).trajectory();
    const TrajectoryValues values = read_values(horizon, trajectory);
    EXPECT_GE(trajectory.chart_switches.size(), 2U) << integrator.name;
    for (int k = 0; k <= 200; ++k) {
      const double angle = 9.0 * 0.01 * k;
      const Eigen::Vector3d tip =
          Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(0.4, -0.3, 0.5);
      EXPECT_LT((values.v().col(k) - tip).norm(), 1e-11) << integrator.name << ' ' << k;
      EXPECT_LT(values.q.col(k).norm(), kChartLimit + 0.1);
    }
  }
}

}  // namespace
}  // namespace hbar
