#include "hbar/adjoint/trajectory/trajectory_residual.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::differences;
using testing::Random;
using testing::relative_gap;
using testing::small_problem;
using testing::spinning_problem;

class TrajectoryResidualOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

/// A trajectory off its solution by about `size`.
Trajectory perturbed(const Trajectory& solution, double size) {
  Trajectory out = solution;
  Random random(7);
  const Eigen::Index stages = out.q.cols() - 1;
  out.q.rightCols(stages) += size * random.matrix(out.q.rows(), stages);
  return out;
}

TEST_P(TrajectoryResidualOfEveryIntegrator, VanishesOnASimulatedTrajectory) {
  Problem problem = small_problem(GetParam());
  Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const Eigen::MatrixXd rates = trajectory.qdot;
  TrajectoryResidual residual(problem.horizon);
  EXPECT_LT(residual.evaluate(trajectory).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_EQ(trajectory.qdot, rates);
}

TEST_P(TrajectoryResidualOfEveryIntegrator, HasTheDerivativeHAlsoOffTheSolution) {
  const auto check = [](Problem problem, double size) {
    const Trajectory solution = simulate(problem.horizon, problem.inputs).trajectory();
    Trajectory at = perturbed(solution, size);
    TrajectoryResidual residual(problem.horizon);
    EXPECT_GT(residual.evaluate(at).lpNorm<Eigen::Infinity>(), 1e-6);
    Linearizer linearizer(problem.horizon);
    const solvers::SparseMatrix H = linearizer.linearize(at).H.matrix();
    const Eigen::Index stages = at.q.cols() - 1;
    Random random(3);
    const Eigen::VectorXd direction = random.vector(H.cols());
    const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
      Trajectory moved = at;
      moved.q.rightCols(stages).reshaped() += e[0] * direction;
      return residual.evaluate(moved);
    };
    const Eigen::VectorXd quotient = differences(along, Eigen::VectorXd::Zero(1), 1e-4);
    EXPECT_LT(relative_gap(H * direction, quotient), 1e-7);
  };
  check(small_problem(GetParam()), 1e-3);
  check(spinning_problem(GetParam()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, TrajectoryResidualOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
