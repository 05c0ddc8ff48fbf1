#include "hbar/adjoint/derivatives/stage_weights.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/trajectory_residual.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::differences;
using testing::Random;
using testing::small_problem;
using testing::spinning_problem;

class StageWeightsOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

/// Ψ as a function of coordinates and the initial rate alone: its weights are its gradient.
void expect_gradient(Problem problem) {
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  TrajectoryResidual rates(problem.horizon);
  const auto value_of = [&](Trajectory at) {
    rates.evaluate(at);
    return problem.objective.value(read_values(problem.horizon, at));
  };
  const TrajectoryValues values = read_values(problem.horizon, trajectory);
  const StageWeights weights =
      stage_weights(problem.horizon, trajectory, problem.objective.partials(values));
  for (const unsigned seed : {1U, 2U, 3U}) {
    Random random(seed);
    const Eigen::MatrixXd dq = random.matrix(trajectory.q.rows(), trajectory.q.cols());
    const Eigen::VectorXd dqdot0 = random.vector(trajectory.q.rows());
    const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
      Trajectory at = trajectory;
      at.q += e[0] * dq;
      at.qdot.col(0) += e[0] * dqdot0;
      return Eigen::VectorXd::Constant(1, value_of(at));
    };
    const double quotient = differences(along, Eigen::VectorXd::Zero(1), 1e-5)(0, 0);
    const double exact = weights.q_bar.cwiseProduct(dq).sum() + weights.qdot0.dot(dqdot0);
    EXPECT_NEAR(exact, quotient, 1e-7 * std::abs(quotient));
  }
}

TEST_P(StageWeightsOfEveryIntegrator, AreTheObjectivesGradientByCoordinates) {
  expect_gradient(small_problem(GetParam()));
}

TEST_P(StageWeightsOfEveryIntegrator, PassThroughAChangeOfChart) {
  expect_gradient(spinning_problem(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, StageWeightsOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
