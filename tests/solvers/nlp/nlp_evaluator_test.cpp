#include "hbar/solvers/nlp/nlp_evaluator.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/programs.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::Rosenbrock;

TEST(NlpEvaluator, CallsOncePerPointAndOnlyWhenAsked) {
  Hs071 program;
  NlpEvaluator evaluator(program, 1e-6);
  const Eigen::VectorXd x = program.variables_.start;
  for (int repeat = 0; repeat < 3; ++repeat) {
    ASSERT_NE(evaluator.objective(x), nullptr);
    ASSERT_NE(evaluator.jacobian(x), nullptr);
  }
  EXPECT_EQ(evaluator.counts().objective, 1);
  EXPECT_EQ(evaluator.counts().jacobian, 1);
  EXPECT_EQ(evaluator.counts().gradient, 0);
  EXPECT_EQ(evaluator.counts().constraints, 0);
  ASSERT_NE(evaluator.objective(2.0 * x), nullptr);
  EXPECT_EQ(evaluator.counts().objective, 2);
  EXPECT_EQ(*evaluator.objective(x), program.objective(x));
}

TEST(NlpEvaluator, EvaluatesTheHessianOncePerPointAndMultipliers) {
  Hs071 program;
  NlpEvaluator evaluator(program, 1e-6);
  const Eigen::VectorXd x = program.variables_.start;
  const Eigen::Vector2d lambda(0.5, -1.0);
  Eigen::VectorXd expected(10);
  program.lagrangian_hessian(x, 2.0, lambda, HessianKind::kExact, expected);
  for (int repeat = 0; repeat < 3; ++repeat) {
    const Eigen::VectorXd* values = evaluator.hessian(x, 2.0, lambda, HessianKind::kExact);
    ASSERT_NE(values, nullptr);
    EXPECT_EQ(*values, expected);
  }
  EXPECT_EQ(evaluator.counts().hessian, 1);
  EXPECT_EQ(evaluator.counts().objective, 0) << "nothing else is evaluated";
  ASSERT_NE(evaluator.hessian(x, 1.0, lambda, HessianKind::kExact), nullptr);
  ASSERT_NE(evaluator.hessian(x, 1.0, 2.0 * lambda, HessianKind::kExact), nullptr);
  ASSERT_NE(evaluator.hessian(x, 1.0, 2.0 * lambda, HessianKind::kGaussNewton), nullptr);
  ASSERT_NE(evaluator.hessian(2.0 * x, 1.0, 2.0 * lambda, HessianKind::kGaussNewton), nullptr);
  EXPECT_EQ(evaluator.counts().hessian, 5);
}

TEST(NlpEvaluator, PrefersFeasiblePointsThenTheLeastObjective) {
  Hs071 program;
  program.limits_.lower[1] = 0.0;
  NlpEvaluator evaluator(program, 1e-6);
  const auto visit = [&](const Eigen::Vector4d& x) {
    ASSERT_NE(evaluator.objective(x), nullptr);
    ASSERT_NE(evaluator.constraints(x), nullptr);
  };
  EXPECT_FALSE(evaluator.best().found);
  visit({1, 1, 1, 1});
  EXPECT_EQ(evaluator.best().violation, 24.0);
  visit({1, 1, 1, 2});
  EXPECT_EQ(evaluator.best().violation, 23.0);
  EXPECT_FALSE(evaluator.best().feasible);
  visit({3, 3, 3, 3});
  EXPECT_TRUE(evaluator.best().feasible);
  visit({1, 1, 1, 1});
  visit({2.5, 2.5, 2.5, 2.5});
  visit({2.9, 2.9, 2.9, 2.9});
  EXPECT_EQ(evaluator.best().x, Eigen::Vector4d(2.5, 2.5, 2.5, 2.5));
  EXPECT_EQ(evaluator.best().objective, program.objective(evaluator.best().x));
}

TEST(NlpEvaluator, TurnsFailuresAndBadNumbersIntoNothing) {
  Rosenbrock program;
  NlpEvaluator evaluator(program, 1e-6);
  program.on_objective = [](const Eigen::VectorXd&) { throw EvaluationError("stalled"); };
  EXPECT_EQ(evaluator.objective(Eigen::Vector2d(1, 2)), nullptr);
  EXPECT_EQ(evaluator.objective(Eigen::Vector2d(1, 2)), nullptr) << "a failure is kept, too";
  EXPECT_EQ(evaluator.counts().objective, 1);
  EXPECT_EQ(evaluator.counts().failures, 1);
  EXPECT_EQ(evaluator.last_failure(), "stalled");
  EXPECT_EQ(evaluator.exception(), nullptr);
  program.on_objective = nullptr;
  EXPECT_EQ(evaluator.objective(Eigen::Vector2d(1e200, 2)), nullptr);
  EXPECT_EQ(evaluator.last_failure(), "nlp: the objective is inf");
  EXPECT_EQ(evaluator.gradient(Eigen::Vector2d(1e200, 2)), nullptr);
  EXPECT_NE(evaluator.last_failure().find("nlp: entry 0 of the objective's gradient is "),
            std::string::npos);
  EXPECT_FALSE(evaluator.best().found);
}

TEST(NlpEvaluator, KeepsOtherExceptionsAndCallsNothingAfterwards) {
  Rosenbrock program;
  NlpEvaluator evaluator(program, 1e-6);
  program.on_objective = [](const Eigen::VectorXd&) { throw std::logic_error("a bug"); };
  EXPECT_EQ(evaluator.objective(Eigen::Vector2d(1, 2)), nullptr);
  ASSERT_NE(evaluator.exception(), nullptr);
  EXPECT_THROW(std::rethrow_exception(evaluator.exception()), std::logic_error);
  EXPECT_EQ(evaluator.gradient(Eigen::Vector2d(1, 2)), nullptr);
  EXPECT_EQ(evaluator.counts().gradient, 0);
}

}  // namespace
}  // namespace hbar::solvers
