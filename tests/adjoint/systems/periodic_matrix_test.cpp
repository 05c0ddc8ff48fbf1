#include "hbar/adjoint/systems/periodic_matrix.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/trajectory_residual.h"
#include "hbar/core/base/error.h"
#include "tests/support/numerics.h"
#include "tests/support/periodic_problems.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::differences;
using testing::driven_pendulum;
using testing::Random;
using testing::relative_gap;
using testing::small_problem;
using testing::spinning_problem;

class PeriodicMatrixOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

/// Makes the last state the initial one; the last rate follows from coordinates alone.
void close(const Horizon& horizon, Trajectory& at) {
  const int last = at.timeline.last_stage();
  at.q.col(0) = at.q.col(last);
  StagePoint<double> end(horizon.model());
  History(horizon.model()).set_point(at, last, end);
  at.qdot.col(0) = end.qdot;
}

void expect_derivative(Problem problem) {
  Trajectory at = simulate(problem.horizon, problem.inputs).trajectory();
  const int last = at.timeline.last_stage();
  TrajectoryResidual residual(problem.horizon);
  close(problem.horizon, at);
  residual.evaluate(at);
  Linearizer linearizer(problem.horizon);
  const solvers::SparseMatrix H =
      periodic_matrix(problem.horizon.model(), at, linearizer.linearize(at));
  for (const unsigned seed : {1U, 2U}) {
    const Eigen::VectorXd direction = Random(seed).vector(H.cols());
    const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
      Trajectory moved = at;
      moved.q.rightCols(last).reshaped() += e[0] * direction;
      close(problem.horizon, moved);
      return residual.evaluate(moved);
    };
    EXPECT_LT(relative_gap(H * direction, differences(along, Eigen::VectorXd::Zero(1), 1e-4)),
              1e-7);
  }
}

TEST_P(PeriodicMatrixOfEveryIntegrator, IsTheDerivativeOfThePeriodicResidual) {
  expect_derivative(driven_pendulum(GetParam(), 12));
  expect_derivative(small_problem(GetParam()));
}

TEST_P(PeriodicMatrixOfEveryIntegrator, IsSoForATrajectoryOfOneStep) {
  expect_derivative(driven_pendulum(GetParam(), 1));
  expect_derivative(driven_pendulum(GetParam(), 2));
}

TEST_P(PeriodicMatrixOfEveryIntegrator, HasBlocksAboveTheDiagonalInTheLastColumnsAlone) {
  Problem problem = driven_pendulum(GetParam(), 12);
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  Linearizer linearizer(problem.horizon);
  const Linearization& system = linearizer.linearize(trajectory);
  const solvers::SparseMatrix P = periodic_matrix(problem.horizon.model(), trajectory, system);
  const solvers::SparseMatrix& H = system.H.matrix();
  const auto stage_of = [](Eigen::Index index) { return static_cast<int>(index / 2) + 1; };
  // A rate looks back on two steps of two stages at most.
  const int last_rows = trajectory.timeline.last_stage() - 5;
  int above = 0;
  for (int j = 0; j < P.cols(); ++j) {
    for (solvers::SparseMatrix::InnerIterator it(P, j); it; ++it) {
      if (stage_of(it.row()) < stage_of(j)) {
        ++above;
        EXPECT_GT(stage_of(j), last_rows);
        EXPECT_LE(stage_of(it.row()), 6);
      } else {
        EXPECT_EQ(it.value(), H.coeff(it.row(), j));
      }
    }
  }
  EXPECT_GT(above, 0);
  EXPECT_EQ(periodic_options(system).structure, solvers::Structure::kPeriodic);
}

TEST(PeriodicMatrix, RefusesAMotionThatEndsInAnotherChart) {
  Problem problem = spinning_problem("bdf1");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  ASSERT_EQ(trajectory.chart_switches.size() % 2, 1U);
  EXPECT_THROW(refuse_changed_charts(problem.horizon.model(), trajectory), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, PeriodicMatrixOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
