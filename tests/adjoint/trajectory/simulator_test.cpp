#include "hbar/adjoint/trajectory/simulator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <thread>

#include "hbar/core/base/chart.h"
#include "hbar/core/base/error.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using testing::make_simulator;
using testing::message_of;
using testing::options_of;
using testing::relative_gap;

/// Positions and velocities at the steps' ends of the slider.
Eigen::Matrix2Xd states_of(Simulator& simulator, double q0, double qdot0, double force = 0.0) {
  Inputs inputs = simulator.nominal_inputs();
  inputs.q0[0] = q0;
  inputs.qdot0[0] = qdot0;
  inputs.u.setConstant(force);
  const TrajectoryValues values = simulator.values(simulator.rollout(inputs).trajectory());
  Eigen::Matrix2Xd states(2, values.q.cols());
  states << values.q, values.qdot;
  return states;
}

TEST(Simulator, FallsAsEachMethodsFormulaSays) {
  constexpr double kH = 0.1;
  constexpr double g = 9.81;
  for (const Integrator& integrator : integrators()) {
    Simulator simulator = make_simulator(testing::slider(0.0, testing::kGravity),
                                         options_of(integrator.name, kH, 20));
    const Eigen::Matrix2Xd states = states_of(simulator, 2.0, 3.0);
    for (int k = 0; k <= 20; ++k) {
      const double t = kH * k;
      const double lag = integrator.order == 1 ? 0.5 * g * kH * t : 0.0;
      EXPECT_NEAR(states(0, k), 2.0 + 3.0 * t - 0.5 * g * t * t - lag, 1e-12) << integrator.name;
      EXPECT_NEAR(states(1, k), 3.0 - g * t, 1e-12) << integrator.name;
    }
  }
}

TEST(Simulator, AppliesTheControlOfEachStep) {
  Simulator simulator =
      make_simulator(testing::slider(0.0, Eigen::Vector3d::Zero()), options_of("bdf1", 0.5, 3));
  Inputs inputs = simulator.nominal_inputs();
  inputs.u << 2.0, -6.0, 4.0;
  const TrajectoryValues values = simulator.values(simulator.rollout(inputs).trajectory());
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
    Simulator simulator = make_simulator(testing::slider(18.0, Eigen::Vector3d::Zero()),
                                         options_of(integrator.name, kH, 60));
    const Eigen::Matrix2Xd states = states_of(simulator, 1.0, -0.5);
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
  Simulator simulator = make_simulator(model, options_of("bdf2", 0.05, 30));
  Inputs inputs = simulator.nominal_inputs();
  inputs.q0[0] = 1.0;
  inputs.p[simulator.parameters().find("joint.slide.stiffness")] = 50.0;
  Simulator stiffer =
      make_simulator(testing::slider(50.0, Eigen::Vector3d::Zero()), options_of("bdf2", 0.05, 30));
  Inputs nominal = stiffer.nominal_inputs();
  nominal.q0[0] = 1.0;
  EXPECT_EQ(simulator.rollout(inputs).trajectory().q, stiffer.rollout(nominal).trajectory().q);
  // And takes them back again.
  inputs.p = simulator.parameters().nominal();
  Simulator fresh = make_simulator(model, options_of("bdf2", 0.05, 30));
  EXPECT_EQ(simulator.rollout(inputs).trajectory().q, fresh.rollout(inputs).trajectory().q);
}

TEST(Simulator, GivesValuesInTheirShapes) {
  const Model model = testing::random_model(31);
  Simulator simulator = make_simulator(model, options_of("bdf2", 0.01, 4));
  testing::Random random(1);
  Inputs inputs = simulator.nominal_inputs();
  inputs.q0 = random.vector(model.dof(), 0.3);
  inputs.qdot0 = random.vector(model.dof(), 0.3);
  const Trajectory trajectory = simulator.rollout(inputs).trajectory();
  const TrajectoryValues values = simulator.values(trajectory);
  EXPECT_EQ(values.q.rows(), model.dof());
  EXPECT_EQ(values.q.cols(), 5);
  EXPECT_EQ(values.qdot.cols(), 5);
  EXPECT_EQ(values.v.rows(), model.variable_count());
  EXPECT_EQ(values.v.cols(), 5);
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

TEST(Simulator, SetsAPointThatSolvesItsStage) {
  const Model model = testing::random_model(32);
  testing::Random random(2);
  for (const Integrator& integrator : integrators()) {
    Simulator simulator = make_simulator(model, options_of(integrator.name, 0.01, 3));
    Inputs inputs = simulator.nominal_inputs();
    inputs.q0 = random.vector(model.dof(), 0.3);
    const Trajectory trajectory = simulator.rollout(inputs).trajectory();
    StagePoint<double> point(model);
    StageResidual<double> residual(model);
    const auto mechanism = nominal_mechanism<double>(model);
    Eigen::VectorXd g(model.dof());
    for (int s = 1; s < trajectory.timeline.stage_count(); ++s) {
      simulator.set_point(trajectory, s, point);
      residual.residual(mechanism, point, g);
      EXPECT_LT(g.norm(), simulator.options().newton.tol) << integrator.name << ' ' << s;
      EXPECT_EQ(point.q, trajectory.q.col(s));
      EXPECT_EQ(point.qdot, trajectory.qdot.col(s));
    }
  }
}

TEST(Simulator, RefusesBadOptions) {
  const Model model = testing::double_pendulum();
  const auto message = [&](const SimulationOptions& options) {
    return message_of<InvalidInput>([&] { make_simulator(model, options); });
  };
  EXPECT_EQ(message(options_of("rk4", 0.1, 3)),
            "there is no integrator 'rk4'; known: bdf1, sdirk2, bdf2");
  EXPECT_EQ(message(options_of("bdf1", 0.0, 3)), "time step h is 0; it must be positive");
  EXPECT_EQ(message(options_of("bdf1", -0.1, 3)), "time step h is -0.1; it must be positive");
  EXPECT_EQ(message(options_of("bdf1", std::numeric_limits<double>::infinity(), 3)),
            "time step h is inf; it must be positive");
  EXPECT_NE(message(options_of("bdf1", std::numeric_limits<double>::quiet_NaN(), 3)), "");
  EXPECT_EQ(message(options_of("bdf1", 0.1, 0)), "steps is 0; it must be at least 1");
  EXPECT_EQ(message(options_of("bdf1", 0.1, -5)), "steps is -5; it must be at least 1");
}

TEST(Simulator, RefusesAHorizonThatWouldNotFit) {
  SimulationOptions options = options_of("bdf1", 0.1, 1'000'000'000);
  const std::string message =
      message_of<InvalidInput>([&] { make_simulator(testing::double_pendulum(), options); });
  EXPECT_EQ(message,
            "1000000000 steps of 2 coordinates take about 192 GB; the limit is 4 GB: take fewer "
            "steps or raise max_memory");
}

TEST(Simulator, DropsFactorsThatWouldNotFit) {
  SimulationOptions options = options_of("bdf1", 0.1, 10);
  options.max_memory = 10 * 8.0 * (4.0 * 2 + 16.0) + 1.0;
  Simulator simulator = make_simulator(testing::double_pendulum(), options);
  EXPECT_TRUE(simulator.rollout(simulator.nominal_inputs()).trajectory().factors.empty());
}

TEST(Simulator, RefusesAModelWithoutCoordinates) {
  EXPECT_EQ(message_of<InvalidInput>([] {
              make_simulator(testing::single_body(FixedJoint{}, testing::kGravity),
                             options_of("bdf1", 0.1, 1));
            }),
            "the model has no coordinate: every joint is fixed");
}

TEST(Simulator, RefusesInputsOfAnotherShapeAndSaysWhich) {
  Simulator simulator =
      make_simulator(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  const auto message = [&](const auto& change) {
    Inputs inputs = simulator.nominal_inputs();
    change(inputs);
    return message_of<InvalidInput>([&] { static_cast<void>(simulator.rollout(inputs)); });
  };
  const int p = simulator.parameters().size();
  EXPECT_EQ(message([](Inputs& x) { x.p.setZero(3); }),
            concat("p is 3 x 1; it must be ", p, " x 1"));
  EXPECT_EQ(message([](Inputs& x) { x.u.setZero(1, 4); }), "u is 1 x 4; it must be 1 x 5");
  EXPECT_EQ(message([](Inputs& x) { x.q0.setZero(2); }), "q0 is 2 x 1; it must be 1 x 1");
  EXPECT_EQ(message([](Inputs& x) { x.qdot0.resize(0); }), "qdot0 is 0 x 1; it must be 1 x 1");
}

TEST(Simulator, RefusesInputsThatAreNotFinite) {
  Simulator simulator =
      make_simulator(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto message = [&](const auto& change) {
    Inputs inputs = simulator.nominal_inputs();
    change(inputs);
    return message_of<InvalidInput>([&] { static_cast<void>(simulator.rollout(inputs)); });
  };
  EXPECT_EQ(message([&](Inputs& x) { x.p[1] = nan; }), "p(1, 0) is nan; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.u(0, 3) = infinity; }), "u(0, 3) is inf; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.q0[0] = nan; }), "q0(0, 0) is nan; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.qdot0[0] = -infinity; }),
            "qdot0(0, 0) is -inf; it must be finite");
}

TEST(Simulator, RefusesAMassThatIsNotPositive) {
  Simulator simulator =
      make_simulator(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  Inputs inputs = simulator.nominal_inputs();
  inputs.p[simulator.parameters().find("body.mass.mass")] = -1.0;
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(simulator.rollout(inputs)); }),
            "body.mass.mass is -1; it must be positive");
}

TEST(Simulator, StopsBeforeTheNextStepWhenAsked) {
  std::atomic<bool> stop = true;
  SimulationOptions options = options_of("bdf1", 0.1, 5);
  options.stop = &stop;
  Simulator simulator = make_simulator(testing::double_pendulum(), options);
  const Rollout stopped = simulator.rollout(simulator.nominal_inputs());
  EXPECT_FALSE(stopped.converged());
  EXPECT_EQ(stopped.report().status, RolloutStatus::kInterrupted);
  EXPECT_EQ(stopped.report().steps_done, 0);
  EXPECT_EQ(stopped.report().message, "simulation interrupted after 0 of 5 steps");
  EXPECT_EQ(stopped.partial().q.cols(), 1);
  EXPECT_EQ(message_of<NumericalFailure>([&] { static_cast<void>(stopped.trajectory()); }),
            "simulation interrupted after 0 of 5 steps");
  stop = false;
  EXPECT_TRUE(simulator.rollout(simulator.nominal_inputs()).converged());
}

TEST(Simulator, KeepsWhatItReachedWhenStoppedHalfWay) {
  std::atomic<bool> stop = false;
  SimulationOptions options = options_of("bdf1", 1e-3, 2'000'000);
  options.stop = &stop;
  options.keep_factors = false;
  Simulator simulator = make_simulator(testing::double_pendulum(), options);
  const Inputs inputs = simulator.nominal_inputs();
  const std::jthread interrupt([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    stop = true;
  });
  const Rollout rollout = simulator.rollout(inputs);
  const int done = rollout.report().steps_done;
  EXPECT_EQ(rollout.report().status, RolloutStatus::kInterrupted);
  EXPECT_LT(done, options.steps);
  EXPECT_EQ(rollout.partial().step_count(), done);
  EXPECT_EQ(rollout.partial().q.cols(), done + 1);
  EXPECT_NEAR(rollout.report().time, 1e-3 * done, 1e-9 * (1 + done));
  EXPECT_EQ(simulator.values(rollout.partial()).q.cols(), done + 1);
}

TEST(Simulator, ChangesChartBeyondTheLimitAndKeepsTheMotion) {
  for (const Integrator& integrator : integrators()) {
    const Model model = testing::single_body(SphericalExpJoint{}, Eigen::Vector3d::Zero());
    Simulator simulator = make_simulator(model, options_of(integrator.name, 0.01, 200));
    Inputs inputs = simulator.nominal_inputs();
    inputs.qdot0 = Eigen::Vector3d(0.0, 0.0, 9.0);  // about a principal axis
    const Trajectory trajectory = simulator.rollout(inputs).trajectory();
    const TrajectoryValues values = simulator.values(trajectory);
    EXPECT_GE(trajectory.chart_switches.size(), 2U) << integrator.name;
    for (int k = 0; k <= 200; ++k) {
      const double angle = 9.0 * 0.01 * k;
      const Eigen::Vector3d tip =
          Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(0.4, -0.3, 0.5);
      EXPECT_LT((values.v.col(k) - tip).norm(), 1e-11) << integrator.name << ' ' << k;
      EXPECT_LT(values.q.col(k).norm(), kChartLimit + 0.1);
    }
  }
}

}  // namespace
}  // namespace hbar
