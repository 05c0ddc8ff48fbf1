#include "hbar/solvers/nlp/nlopt.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kHs071Objective;
using testing::kHs071Optimum;
using testing::message_of;
using testing::Rosenbrock;

TEST(Nlopt, FindsTheMinimumOfRosenbrock) {
  Rosenbrock program;
  const NloptResult result = minimise_with_nlopt(program);
  EXPECT_EQ(result.status, NloptStatus::kOptimal) << result.message;
  EXPECT_LT((result.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-5);
  EXPECT_LE(result.stationarity, 1e-6);
  EXPECT_EQ(result.message.find("nlopt: optimal after "), 0U) << result.message;
  EXPECT_EQ(result.evaluations.objective, static_cast<int>(program.visits.size()))
      << "once per point";
}

TEST(Nlopt, StaysWithinBoundsAndGivesTheirMultipliers) {
  Rosenbrock program;
  program.variables_.upper << 0.5, 2.0;
  program.variables_.lower << -2.0, -2.0;
  program.on_objective = [&](const Eigen::VectorXd& x) {
    EXPECT_LE(x[0], 0.5);
    EXPECT_GE(x[1], -2.0);
  };
  const NloptResult result = minimise_with_nlopt(program);
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_NEAR(result.x[0], 0.5, 1e-12);
  EXPECT_NEAR(result.x[1], 0.25, 1e-8);
  // There df/dx0 = −2 (1 − x0) = −1.
  EXPECT_NEAR(result.upper_multipliers[0], 1.0, 1e-5);
  EXPECT_EQ(result.lower_multipliers, Eigen::Vector2d(0.0, 0.0));
}

TEST(Nlopt, GivesResultsInTheProgramsUnitsWhateverTheScale) {
  Rosenbrock program;
  program.variables_.upper << 0.5, 2.0;
  program.variables_.scale = Eigen::Vector2d(0.3, 5.0);
  const NloptResult result = minimise_with_nlopt(program, {.objective_scale = 4.0});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LT((result.x - Eigen::Vector2d(0.5, 0.25)).norm(), 1e-5);
  EXPECT_NEAR(result.objective, 0.25, 1e-8);
  EXPECT_NEAR(result.upper_multipliers[0], 1.0, 1e-4);
}

TEST(Nlopt, HoldsFixedVariables) {
  Rosenbrock program;
  program.variables_.lower[0] = program.variables_.upper[0] = program.variables_.start[0];
  const NloptResult result = minimise_with_nlopt(program);
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_EQ(result.x[0], -1.2);
  EXPECT_NEAR(result.x[1], 1.44, 1e-7);
}

TEST(Nlopt, SlsqpFindsTheOptimumAndMultipliersOfHs071) {
  Hs071 program;
  program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  const NloptResult result = minimise_with_nlopt(program, {.algorithm = NloptAlgorithm::kSlsqp,
                                                           .optimality_tolerance = 1e-5,
                                                           .constraint_tolerance = 1e-8});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LT((result.x - kHs071Optimum).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_NEAR(result.objective, kHs071Objective, 1e-6);
  EXPECT_NEAR(result.lower_multipliers[0], 1.0878712, 1e-4);
  EXPECT_LT(result.constraint_multipliers[0], 0.0) << "a lower bound holds";
}

TEST(Nlopt, RefusesConstraintsForLbfgs) {
  Hs071 program;
  EXPECT_EQ(message_of<InvalidInput>([&] { (void)minimise_with_nlopt(program); }),
            "nlopt: L-BFGS takes bounds alone, but the program has 2 constraints (the first: "
            "product); take NloptAlgorithm::kSlsqp or Ipopt");
}

TEST(Nlopt, RefusesOptionsOutOfTheirRange) {
  Rosenbrock program;
  EXPECT_EQ(
      message_of<InvalidInput>([&] { (void)minimise_with_nlopt(program, {.max_evaluations = 0}); }),
      "nlopt: max_evaluations is 0; expected a positive number");
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)minimise_with_nlopt(program, {.variable_tolerance = -1.0}); }),
            "nlopt: variable_tolerance is -1; expected a number that is not negative");
}

TEST(Nlopt, ShortensTheStepWhereAPointCannotBeEvaluated) {
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd& x) {
    if (x[1] < -0.05 || x[0] > 1.05) {
      throw EvaluationError("the simulation failed");
    }
  };
  const NloptResult result = minimise_with_nlopt(program);
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_GT(result.evaluations.failures, 0);
}

TEST(Nlopt, SaysWhyTheStartCannotBeEvaluated) {
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd&) { throw EvaluationError("no step fits"); };
  const NloptResult result = minimise_with_nlopt(program);
  EXPECT_EQ(result.status, NloptStatus::kEvaluationFailed);
  EXPECT_EQ(result.x, program.variables_.start);
  EXPECT_TRUE(std::isnan(result.objective));
  EXPECT_EQ(result.message,
            "nlopt: evaluation failed after 1 evaluations: no point could be evaluated; 1 "
            "evaluations failed, the last with: no step fits; start where the program can be "
            "evaluated");
}

TEST(Nlopt, RethrowsWhatProgramAndCallbackThrow) {
  for (const NloptAlgorithm algorithm : {NloptAlgorithm::kLbfgs, NloptAlgorithm::kSlsqp}) {
    Rosenbrock program;
    int calls = 0;
    program.on_objective = [&](const Eigen::VectorXd&) {
      if (++calls == 5) {
        throw std::out_of_range("a bug");
      }
    };
    NloptOptions options{.algorithm = algorithm};
    const auto run = [&] { (void)minimise_with_nlopt(program, options); };
    EXPECT_EQ(message_of<std::out_of_range>(run), "a bug");
    EXPECT_EQ(calls, 5) << "nothing may be evaluated after an exception";
    program.on_objective = nullptr;
    options.on_evaluation = [](const NloptEvaluation& e) -> bool {
      if (e.evaluation == 3) {
        throw std::runtime_error("disk full");
      }
      return true;
    };
    EXPECT_EQ(message_of<std::runtime_error>(run), "disk full");
  }
}

TEST(Nlopt, StopsWhenTold) {
  Rosenbrock program;
  std::atomic<bool> stop = false;
  int seen = 0;
  double first = 0.0;
  NloptOptions options;
  options.stop = &stop;
  options.on_evaluation = [&](const NloptEvaluation& e) {
    seen = e.evaluation;
    first = e.evaluation == 1 ? e.objective : first;
    return e.evaluation < 4;
  };
  NloptResult result = minimise_with_nlopt(program, options);
  EXPECT_EQ(result.status, NloptStatus::kStopped);
  EXPECT_EQ(seen, 4);
  EXPECT_NEAR(first, 24.2, 1e-12);
  EXPECT_EQ(result.objective, program.objective(result.x));
  options.on_evaluation = [&](const NloptEvaluation&) { return stop = true; };
  EXPECT_EQ(minimise_with_nlopt(program, options).status, NloptStatus::kInterrupted);
  result = minimise_with_nlopt(program, {.max_evaluations = 5});
  EXPECT_EQ(result.status, NloptStatus::kEvaluationLimit);
  EXPECT_EQ(result.evaluations.objective, 5);
  EXPECT_EQ(minimise_with_nlopt(program, {.max_wall_time = 1e-9}).status, NloptStatus::kTimeLimit);
}

TEST(Nlopt, DoesNotCallAWrongGradientOptimal) {
  Rosenbrock program;
  program.gradient_factor = -1.0;
  const NloptResult result = minimise_with_nlopt(program);
  EXPECT_FALSE(result.converged());
  EXPECT_NE(result.message.find("check the gradients"), std::string::npos) << result.message;
}

}  // namespace
}  // namespace hbar::solvers
