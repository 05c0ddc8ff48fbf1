#include "hbar/adjoint/derivatives/assembled_adjoint.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/solvers/linear/klu.h"
#ifdef HBAR_HAVE_UMFPACK
#include "hbar/solvers/linear/umfpack.h"
#endif
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;
using testing::spinning_problem;

std::vector<solvers::SolverFactory> every_solver() {
  return {nullptr,  // block substitution
          [](const auto& options, const auto&) { return solvers::make_klu(options); },
#ifdef HBAR_HAVE_UMFPACK
          [](const auto& options, const auto&) { return solvers::make_umfpack(options); }
#endif
  };
}

class AssembledAdjointOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(AssembledAdjointOfEveryIntegrator, HasTheSweepsGradientFromEverySolver) {
  for (const bool spinning : {false, true}) {
    Problem problem = spinning ? spinning_problem(GetParam()) : small_problem(GetParam());
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const Gradient swept = gradient(problem.horizon, trajectory, problem.objective);
    for (const solvers::SolverFactory& factory : every_solver()) {
      AssembledAdjoint assembled(problem.horizon, factory);
      const Gradient ours = assembled.gradient(trajectory, problem.objective);
      const std::string name = assembled.solver().name();
      EXPECT_EQ(ours.value, swept.value) << name;
      EXPECT_LT((ours.p - swept.p).norm(), 1e-11 * swept.p.norm()) << name;
      EXPECT_LE((ours.u - swept.u).norm(), 1e-11 * swept.u.norm()) << name;
      EXPECT_LT((ours.q0 - swept.q0).norm(), 1e-11 * swept.q0.norm()) << name;
      EXPECT_LT((ours.qdot0 - swept.qdot0).norm(), 1e-11 * swept.qdot0.norm()) << name;
    }
  }
}

TEST_P(AssembledAdjointOfEveryIntegrator, AnalysesItsPatternOnce) {
  Problem problem = small_problem(GetParam());
  AssembledAdjoint assembled(
      problem.horizon, [](const auto& options, const auto&) { return solvers::make_klu(options); });
  for (int i = 0; i < 4; ++i) {
    problem.inputs.q0[0] += 0.01;
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    EXPECT_GT(assembled.gradient(trajectory, problem.objective).value, 0.0);
  }
  EXPECT_EQ(assembled.solver().statistics().analyses, 1);
  EXPECT_EQ(assembled.solver().statistics().factorizations, 4);
}

INSTANTIATE_TEST_SUITE_P(All, AssembledAdjointOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
