// Every function of a program, and every callback, goes wrong in every way at every call.

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/faulty_program.h"

namespace hbar::solvers {
namespace {

using testing::ending_of;
using testing::FaultyHs071;
using Function = FaultyHs071::Function;

/// Whatever happened, no number that was reached is one that is none.
void expect_finite(const IpoptResult& result) {
  if (!std::isfinite(result.objective)) {  // nothing could be evaluated
    EXPECT_FALSE(result.converged());
    EXPECT_EQ(result.status, IpoptStatus::kEvaluationFailed) << result.message;
    EXPECT_NE(result.message.find("no point could be evaluated"), std::string::npos);
    return;
  }
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_TRUE(result.c.allFinite());
  EXPECT_EQ(result.objective, testing::Hs071().objective(result.x));
  if (result.converged()) {
    EXPECT_NEAR(result.objective, testing::kHs071Objective, 1e-5) << result.message;
  }
}

TEST(IpoptFaults, OfEveryFunctionAtEveryCall) {
  testing::expect_every_fault(
      {Function::kObjective, Function::kGradient, Function::kConstraints, Function::kJacobian,
       Function::kHessian},
      [](FaultyHs071& program) {
        IpoptOptions options;
        options.hessian = HessianKind::kExact;
        options.max_iterations = 60;
        return solve_with_ipopt(program, options);
      },
      expect_finite);
}

TEST(IpoptFaults, OfEveryCallbackAtEveryCall) {
  for (int place = 0; place < 9; ++place) {
    testing::Hs071 program;
    IpoptOptions options;
    options.checkpoint_every = 0.0;
    options.on_iteration = [place](const IterationInfo& info) { return info.iteration != place; };
    const IpoptResult stopped = solve_with_ipopt(program, options);
    expect_finite(stopped);
    EXPECT_EQ(stopped.status,
              stopped.iterations < place ? IpoptStatus::kOptimal : IpoptStatus::kStopped);

    options.on_iteration = [place](const IterationInfo& info) -> bool {
      return info.iteration == place ? throw 42 : true;
    };
    EXPECT_EQ(ending_of([&] { (void)solve_with_ipopt(program, options); }),
              stopped.status == IpoptStatus::kStopped ? "42" : "returned");

    options.on_iteration = {};
    int calls = 0;
    options.on_checkpoint = [&calls, place](const IpoptResult& result) {
      expect_finite(result);
      if (calls++ == place) {
        throw std::bad_alloc();
      }
    };
    EXPECT_EQ(ending_of([&] { (void)solve_with_ipopt(program, options); }), "bad_alloc");
  }
}

}  // namespace
}  // namespace hbar::solvers
