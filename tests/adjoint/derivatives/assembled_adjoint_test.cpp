#include "hbar/adjoint/derivatives/assembled_adjoint.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#ifdef HBAR_HAVE_UMFPACK
#include "hbar/umfpack.h"
#endif
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;
using testing::spinning_problem;

std::vector<std::string> names_of_solvers() {
  return {"auto", "block_substitution", "klu",
#ifdef HBAR_HAVE_UMFPACK
          "umfpack"
#endif
  };
}

class AssembledAdjointOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(AssembledAdjointOfEveryIntegrator, HasTheSweepsGradientFromEverySolver) {
  for (const bool spinning : {false, true}) {
    Problem problem = spinning ? spinning_problem(GetParam()) : small_problem(GetParam());
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const Gradient swept = gradient(problem.horizon, trajectory, problem.objective);
    for (const std::string& name : names_of_solvers()) {
      const Gradient ours =
          gradient(problem.horizon, trajectory, problem.objective, solver_factory(name));
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
  AssembledAdjoint assembled(problem.horizon, solver_factory("klu"));
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
