#include "hbar/adjoint/derivatives/factorized_linearization.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;

TEST(FactorizedLinearization, AnalysesOnceAndFactorisesEveryTime) {
  Problem problem = small_problem("bdf2");
  FactorizedLinearization system(problem.horizon);
  for (int i = 1; i <= 3; ++i) {
    problem.inputs.q0[0] += 0.01;
    system.update(simulate(problem.horizon, problem.inputs).trajectory());
    EXPECT_EQ(system.solver().statistics().analyses, 1);
    EXPECT_EQ(system.solver().statistics().factorizations, i);
  }
  EXPECT_EQ(system.solver().name(), "block_substitution");
}

TEST(FactorizedLinearization, TakesASolverForItsMatrix) {
  Problem problem = small_problem("bdf1");
  const int rows = problem.horizon.model().dof() * problem.horizon.options().steps;
  bool was_asked = false;
  FactorizedLinearization system(
      problem.horizon, [&](const solvers::SolverOptions& options, const solvers::SparseMatrix& A) {
        was_asked = true;
        EXPECT_EQ(options.structure, solvers::Structure::kBlockTriangular);
        EXPECT_EQ(options.block_sizes.size(),
                  static_cast<std::size_t>(problem.horizon.options().steps));
        EXPECT_EQ(A.rows(), rows);
        return solvers::default_solver()(options, A);
      });
  system.update(simulate(problem.horizon, problem.inputs).trajectory());
  EXPECT_TRUE(was_asked);
}

TEST(StageNames, NameStageTimeAndCoordinate) {
  Problem problem = small_problem("bdf1");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const auto name = stage_names(problem.horizon, trajectory.timeline);
  const int n = problem.horizon.model().dof();
  EXPECT_EQ(name(6), "stage 1 (t = 0.01), coordinate hinge");
  EXPECT_EQ(name(4 * n + 6), "stage 5 (t = 0.05), coordinate hinge");
  EXPECT_EQ(name(5 * n - 1), "stage 5 (t = 0.05), coordinate slider");
}

}  // namespace
}  // namespace hbar
