// Every function of a program, and every callback, goes wrong in every way at every call.

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/faulty_program.h"

namespace hbar::solvers {
namespace {

using testing::ending_of;
using testing::expected_ending;
using testing::Fault;
using testing::FaultyHs071;
using testing::kFaults;
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
  for (const Function function : {Function::kObjective, Function::kGradient, Function::kConstraints,
                                  Function::kJacobian, Function::kHessian}) {
    for (const Fault fault : kFaults) {
      for (const bool onwards : {false, true}) {
        int happened = 1;
        for (int place = 1; happened > 0 && place < 40; ++place) {
          FaultyHs071 program(function, fault, place, onwards);
          IpoptOptions options;
          options.hessian = HessianKind::kExact;
          options.max_iterations = 60;
          IpoptResult result;
          const std::string found = ending_of([&] { result = solve_with_ipopt(program, options); });
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
