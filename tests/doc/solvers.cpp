// The snippets of doc/solvers.md, run on the arm of examples/scenes.

#include <gtest/gtest.h>

#include "hbar/hbar.h"
#include "hbar/suite.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

TEST(SolversPage, SolvesASystemOfATrajectory) {
  const Horizon horizon(testing::example_model("arm.xml"), {},
                        {.integrator = "bdf2", .h = 0.01, .steps = 40});
  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();

  const TrajectorySystem system = assemble_system(SystemKind::kKkt, horizon, trajectory);
  const auto solver = solvers::make_solver("auto", system.options, system.A);
  solver->name_unknowns(system.name_of_unknown);  // a singular pivot is named: stage, coordinate
  solver->analyze(system.A);                      // once per pattern
  solver->factorize(system.A);                    // once per values
  Eigen::VectorXd x(system.b.size());
  solver->solve(system.b, x);  // one or many columns; solve_transposed likewise
  const solvers::FactorInfo factors = solver->factor_info();  // entries, bytes, operations, inertia

  EXPECT_LE(solvers::normwise_backward_error(system.A, solvers::System::kPlain, x, system.b),
            1e-14);
  EXPECT_GT(factors.entries, 0.0);
  if (factors.inertia) {
    EXPECT_EQ(factors.inertia->negative, horizon.model().dof() * trajectory.timeline.last_stage());
  }
}

TEST(SolversPage, TakesASolverByName) {
  const Horizon horizon(testing::example_model("arm.xml"), {},
                        {.integrator = "bdf2", .h = 0.01, .steps = 40});
  const Objective objective(squared_variables());
  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();

  const Gradient by_klu = gradient(horizon, trajectory, objective, solver_factory("klu"));

  for (const solvers::SolverEntry& solver : solvers::available_solvers()) {
    if (solver.claims(solvers::Structure::kBlockTriangular)) {
      const Gradient other = gradient(horizon, trajectory, objective, solver_factory(solver.name));
      EXPECT_LT((other.u - by_klu.u).norm(), 1e-6 * by_klu.u.norm()) << solver.name;
    }
  }
}

}  // namespace
}  // namespace hbar
