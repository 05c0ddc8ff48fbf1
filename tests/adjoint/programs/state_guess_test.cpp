#include "hbar/adjoint/programs/state_guess.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

constexpr int kGuessedSteps = 30;

TrajectoryProblem guessed_problem(Model model) {
  const ParameterSet set;
  const Eigen::Index controls = model.control_count();
  TrajectoryProblem out{
      .horizon = Horizon(std::move(model), set, testing::options_of("bdf2", 0.02, kGuessedSteps)),
      .map = parameter_map(set),
      .objective = {},
      .constraints = {},
      .controls = {},
      .q0 = Eigen::Vector2d(0.1, -0.3),
      .qdot0 = Eigen::Vector2d(0.5, 0.2)};
  out.controls.start = Eigen::MatrixXd::Zero(controls, 1);
  return out;
}

TEST(StateGuess, IsWhatTheStartSimulates) {
  TrajectoryProblem problem = guessed_problem(testing::double_pendulum());
  const InputVariables head(problem);
  const Eigen::MatrixXd states = guess_states(problem, head, {});
  const Trajectory trajectory =
      simulate(problem.horizon, head.inputs(head.variables().start)).trajectory();
  const TrajectoryValues values = read_values(problem.horizon, trajectory);
  EXPECT_EQ(states.topRows(2), values.q);
  EXPECT_EQ(states.bottomRows(2), values.qdot);
}

TEST(StateGuess, RestsFromWhereTheSimulationFails) {
  TrajectoryProblem problem = guessed_problem(testing::stiff_pendulum(false));
  SimulationOptions options = problem.horizon.options();
  options.max_halvings = 0;
  options.newton.max_iter = 5;  // enough for swinging, not for the stop
  problem.horizon = Horizon(problem.horizon.model(), ParameterSet(), options);
  const InputVariables head(problem);
  const Rollout rollout = simulate(problem.horizon, head.inputs(head.variables().start));
  const int done = rollout.partial().step_count();
  ASSERT_FALSE(rollout.converged());
  ASSERT_GT(done, 0);
  ASSERT_LT(done, kGuessedSteps);
  const Eigen::MatrixXd states = guess_states(problem, head, {});
  EXPECT_EQ(states.col(done).head(2), rollout.partial().q_at_step(done));
  EXPECT_EQ(states.col(done).tail(2), rollout.partial().qdot_at_step(done));
  for (int k = done + 1; k <= kGuessedSteps; ++k) {
    EXPECT_EQ(states.col(k).head(2), states.col(done).head(2)) << k;
    EXPECT_EQ(states.col(k).tail(2), Eigen::Vector2d::Zero()) << k;
  }
}

TEST(StateGuess, TakesAGuessOfTheMotionWithItsDifferenceQuotients) {
  TrajectoryProblem problem = guessed_problem(testing::double_pendulum());
  problem.q0 = Eigen::Vector2d(0.0, 1.0);
  const InputVariables head(problem);
  Eigen::MatrixXd q_guess(2, kGuessedSteps + 1);
  for (int k = 0; k <= kGuessedSteps; ++k) {
    q_guess.col(k) << 0.25 * k, 1.0 - 0.5 * k;  // exact in binary
  }
  const Eigen::MatrixXd states = guess_states(problem, head, q_guess);
  EXPECT_EQ(states.topRows(2), q_guess);
  const Eigen::Vector2d rate(0.25 / 0.02, -0.5 / 0.02);
  EXPECT_LT(testing::relative_gap(states.bottomRows(2), rate.replicate(1, kGuessedSteps + 1)),
            1e-15);
}

TEST(StateGuess, RefusesAGuessOfAnotherShape) {
  TrajectoryProblem problem = guessed_problem(testing::double_pendulum());
  const InputVariables head(problem);
  EXPECT_EQ(testing::message_of<InvalidInput>([&] {
              static_cast<void>(guess_states(problem, head, Eigen::MatrixXd::Zero(2, 30)));
            }),
            "transcription: q_guess is 2 x 30; it must be 2 x 31 and finite");
  Eigen::MatrixXd q_guess = Eigen::MatrixXd::Zero(2, kGuessedSteps + 1);
  q_guess(1, 7) = testing::kNan;
  EXPECT_THROW(static_cast<void>(guess_states(problem, head, q_guess)), InvalidInput);
}

}  // namespace
}  // namespace hbar
