// Every function of a program, and the callback, goes wrong in every way at every call.

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/nlopt.h"
#include "tests/support/faulty_program.h"

namespace hbar::solvers {
namespace {

using testing::ending_of;
using testing::FaultyHs071;
using Function = FaultyHs071::Function;

void expect_finite(const NloptResult& result) {
  if (!std::isfinite(result.objective)) {  // nothing could be evaluated
    EXPECT_FALSE(result.converged());
    return;
  }
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_TRUE(result.c.allFinite());
  EXPECT_EQ(result.objective, testing::Hs071().objective(result.x));
  if (result.converged()) {
    EXPECT_NEAR(result.objective, testing::kHs071Objective, 1e-5) << result.message;
  }
}

TEST(NloptFaults, OfEveryFunctionAtEveryCall) {
  testing::expect_every_fault(
      {Function::kObjective, Function::kGradient, Function::kConstraints, Function::kJacobian},
      [](FaultyHs071& program) {
        NloptOptions options;
        options.algorithm = NloptAlgorithm::kSlsqp;
        options.max_evaluations = 200;
        options.optimality_tolerance = 1e-5;
        program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
        return minimise_with_nlopt(program, options);
      },
      expect_finite);
}

TEST(NloptFaults, OfTheCallbackAtEveryCall) {
  for (int place = 1; place < 6; ++place) {
    testing::Hs071 program;
    NloptOptions options;
    options.algorithm = NloptAlgorithm::kSlsqp;
    options.on_evaluation = [place](const NloptEvaluation& info) {
      return info.evaluation != place;
    };
    const NloptResult stopped = minimise_with_nlopt(program, options);
    EXPECT_EQ(stopped.status, NloptStatus::kStopped);
    expect_finite(stopped);
    options.on_evaluation = [place](const NloptEvaluation& info) -> bool {
      return info.evaluation == place ? throw 42 : true;
    };
    EXPECT_EQ(ending_of([&] { (void)minimise_with_nlopt(program, options); }), "42");
  }
}

}  // namespace
}  // namespace hbar::solvers
