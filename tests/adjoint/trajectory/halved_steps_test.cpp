// Gradients through steps that were halved: exact for the time steps that were taken.

#include <gtest/gtest.h>

#include <random>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

/// The small problem with so few Newton corrections that some steps must be halved.
Problem starved_problem(const std::string& integrator, double speed) {
  Problem problem = testing::small_problem(integrator);
  SimulationOptions options = problem.horizon.options();
  options.h = 0.02;
  options.newton.max_iter = 4;
  problem.horizon = Horizon(problem.horizon.model(), problem.horizon.parameters(), options);
  problem.inputs.qdot0 *= speed;
  return problem;
}

class HalvedStepsOfEveryIntegrator : public ::testing::TestWithParam<std::string> {
 protected:
  /// Which steps are halved depends on the inputs; a derivative exists where nearby inputs need the
  /// same ones. The first speed of which that holds is taken.
  HalvedStepsOfEveryIntegrator() {
    for (const double speed : {4.0, 3.6, 4.4, 3.2, 4.8}) {
      problem_ = starved_problem(GetParam(), speed);
      trajectory_ = simulate(problem_.horizon, problem_.inputs).trajectory();
      draw_direction();
      if (moved(2e-5).timeline == trajectory_.timeline &&
          moved(-2e-5).timeline == trajectory_.timeline) {
        return;
      }
    }
    ADD_FAILURE() << "every speed is at a switch of halving";
  }

  void draw_direction() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    direction_ = Directions::zero(problem_.horizon, 1);
    for (Eigen::MatrixXd* part :
         {&direction_.p, &direction_.u, &direction_.q0, &direction_.qdot0}) {
      *part = part->unaryExpr([&](double) { return uniform(random); });
    }
    direction_.p *= 1e-2;  // masses and moments stay physical
  }

  Trajectory moved(double step) {
    Inputs inputs = problem_.inputs;
    inputs.p += step * direction_.p.col(0);
    inputs.u.reshaped() += step * direction_.u.col(0);
    inputs.q0 += step * direction_.q0.col(0);
    inputs.qdot0 += step * direction_.qdot0.col(0);
    return simulate(problem_.horizon, inputs).trajectory();
  }

  Problem problem_ = starved_problem(GetParam(), 4.0);
  Trajectory trajectory_;
  Directions direction_;
};

TEST_P(HalvedStepsOfEveryIntegrator, GradientIsThatOfTheStepsTaken) {
  Timeline regular;
  for (int k = 0; k < trajectory_.step_count(); ++k) {
    regular.append(find_integrator(GetParam()), k, problem_.horizon.options().h);
  }
  ASSERT_GT(trajectory_.timeline.stage_count(), regular.stage_count());

  const Gradient g = gradient(problem_.horizon, trajectory_, problem_.objective);
  const double slope = g.p.dot(direction_.p.col(0)) + g.u.reshaped().dot(direction_.u.col(0)) +
                       g.q0.dot(direction_.q0.col(0)) + g.qdot0.dot(direction_.qdot0.col(0));
  const auto difference = [&](double step) {
    const Trajectory ahead = moved(step);
    const Trajectory behind = moved(-step);
    EXPECT_EQ(ahead.timeline, trajectory_.timeline);
    EXPECT_EQ(behind.timeline, trajectory_.timeline);
    const auto value = [&](const Trajectory& t) {
      return problem_.objective.value(read_values(problem_.horizon, t));
    };
    return (value(ahead) - value(behind)) / (2.0 * step);
  };
  const double expected = (4.0 * difference(1e-5) - difference(2e-5)) / 3.0;
  EXPECT_NEAR(slope, expected, 1e-7 * std::abs(expected));
}

TEST_P(HalvedStepsOfEveryIntegrator, TangentsAgreeWithTheAdjoint) {
  const Horizon& horizon = problem_.horizon;
  const TrajectoryPartials partials =
      problem_.objective.partials(read_values(horizon, trajectory_));
  AdjointSweep sweep(horizon);
  const Gradient g = sweep.pull_back(trajectory_, partials);
  TangentSweep forward(horizon);
  const Tangents tangents = forward.push_forward(trajectory_, direction_);
  const double slope = g.p.dot(direction_.p.col(0)) + g.u.reshaped().dot(direction_.u.col(0)) +
                       g.q0.dot(direction_.q0.col(0)) + g.qdot0.dot(direction_.qdot0.col(0));
  const double scale = sweep.adjoint().norm() * forward.right_hand_sides().norm();
  EXPECT_NEAR(directional_derivative(partials, tangents, direction_, 0), slope, 1e-12 * scale);
}

INSTANTIATE_TEST_SUITE_P(All, HalvedStepsOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
