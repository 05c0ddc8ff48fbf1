// Every function of a program, and the callback, goes wrong in every way at every call.

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/nlopt.h"
#include "tests/support/faulty_program.h"

namespace hbar::solvers {
namespace {

using testing::ending_of;
using testing::expected_ending;
using testing::Fault;
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
  for (const Function function :
       {Function::kObjective, Function::kGradient, Function::kConstraints, Function::kJacobian}) {
    for (const Fault fault : testing::kFaults) {
      for (const bool onwards : {false, true}) {
        int happened = 1;
        for (int place = 1; happened > 0 && place < 40; ++place) {
          FaultyHs071 program(function, fault, place, onwards);
          NloptOptions options;
          options.algorithm = NloptAlgorithm::kSlsqp;
          options.max_evaluations = 200;
          options.optimality_tolerance = 1e-5;
          program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
          NloptResult result;
          const std::string found =
              ending_of([&] { result = minimise_with_nlopt(program, options); });
          happened = program.happened;
          SCOPED_TRACE(concat("function ", static_cast<int>(function), ", fault ",
                              static_cast<int>(fault), ", call ", place, onwards ? " on" : ""));
          if (happened == 0) {
            EXPECT_EQ(found, "returned");
            EXPECT_TRUE(result.converged());
            continue;
          }
          ASSERT_EQ(found, expected_ending(fault, function, found));
          if (found == "returned") {
            expect_finite(result);
          }
        }
        EXPECT_EQ(happened, 0);  // every call had its turn
      }
    }
  }
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
