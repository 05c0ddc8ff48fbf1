#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kHs071Optimum;
using testing::message_of;
using testing::Rosenbrock;

TEST(IpoptHessian, NeedsFewerIterationsThanLimitedMemory) {
  Rosenbrock program;
  const IpoptResult limited = solve_with_ipopt(program);
  const IpoptResult exact = solve_with_ipopt(program, {.hessian = HessianKind::kExact});
  ASSERT_TRUE(exact.converged()) << exact.message;
  EXPECT_LT((exact.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-8);
  EXPECT_LT(exact.iterations, limited.iterations);
  EXPECT_EQ(limited.evaluations.hessian, 0);
  EXPECT_EQ(exact.evaluations.hessian, exact.iterations);
}

TEST(IpoptHessian, SolvesAProgramWithConstraintsWhateverTheScales) {
  Hs071 plain;
  const IpoptResult reference = solve_with_ipopt(plain, {.hessian = HessianKind::kExact});
  Hs071 scaled;
  scaled.variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
  scaled.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  for (const double objective_scale : {1.0, 10.0}) {
    const IpoptResult result = solve_with_ipopt(
        scaled, {.hessian = HessianKind::kExact, .objective_scale = objective_scale});
    ASSERT_TRUE(result.converged()) << result.message;
    EXPECT_LT((result.x - kHs071Optimum).lpNorm<Eigen::Infinity>(), 1e-7);
    // Quadratic convergence shows that the scaled Hessian is that of the scaled Lagrangian.
    EXPECT_LE(result.iterations, reference.iterations + 4);
    EXPECT_LT((result.constraint_multipliers - reference.constraint_multipliers).norm(), 1e-6);
    EXPECT_LT((result.lower_multipliers - reference.lower_multipliers).norm(), 1e-6);
    EXPECT_LT((result.upper_multipliers - reference.upper_multipliers).norm(), 1e-6);
    EXPECT_NEAR(result.objective, reference.objective, 1e-6);
  }
}

TEST(IpoptHessian, SuffersFromAWrongOne) {
  Rosenbrock program;
  const int right = solve_with_ipopt(program, {.hessian = HessianKind::kExact}).iterations;
  program.hessian_factor = 1.5;
  EXPECT_GT(solve_with_ipopt(program, {.hessian = HessianKind::kExact}).iterations, right);
}

TEST(IpoptHessian, RefusesAProgramWithoutOne) {
  class Straight : public testing::Program {
   public:
    Straight() : Program(Eigen::VectorXd::Ones(1), 0) {}
    double objective(const Eigen::VectorXd& x) override { return x[0] * x[0]; }
    void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override { g = 2.0 * x; }
    void constraints(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
    void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  } program;
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)solve_with_ipopt(program, {.hessian = HessianKind::kGaussNewton}); }),
            "nlp: this program has no second derivatives; use the limited-memory Hessian");
  EXPECT_TRUE(solve_with_ipopt(program).converged());
}

TEST(IpoptWarmStart, FromTheSolutionTakesAtMostThreeIterations) {
  for (const HessianKind hessian : {HessianKind::kExact, HessianKind::kLimitedMemory}) {
    Hs071 program;
    program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
    IpoptOptions options{.hessian = hessian, .objective_scale = 3.0};
    const IpoptResult cold = solve_with_ipopt(program, options);
    ASSERT_TRUE(cold.converged()) << cold.message;
    EXPECT_GE(cold.iterations, 6);
    EXPECT_GT(cold.mu, 0.0);
    EXPECT_LT(cold.mu, 1e-7);
    options.warm_start = cold.point();
    const IpoptResult warm = solve_with_ipopt(program, options);
    ASSERT_TRUE(warm.converged()) << warm.message;
    EXPECT_LE(warm.iterations, 3);
    EXPECT_LT((warm.x - cold.x).norm(), 1e-7);
    EXPECT_LT((warm.constraint_multipliers - cold.constraint_multipliers).norm(), 1e-5);
  }
}

TEST(IpoptWarmStart, SolvesAPerturbedProgramSooner) {
  Hs071 program;
  IpoptOptions options{.hessian = HessianKind::kExact};
  const PrimalDualPoint nearby = solve_with_ipopt(program, options).point();
  program.limits_.lower[1] = program.limits_.upper[1] = 40.1;
  const IpoptResult cold = solve_with_ipopt(program, options);
  options.warm_start = nearby;
  const IpoptResult warm = solve_with_ipopt(program, options);
  ASSERT_TRUE(cold.converged() && warm.converged()) << cold.message << warm.message;
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_LT((warm.x - cold.x).norm(), 1e-6);
  EXPECT_GT((warm.x - nearby.x).norm(), 1e-3);
}

TEST(IpoptWarmStart, IsRefusedWhereItDoesNotFit) {
  Hs071 program;
  IpoptOptions options;
  const auto refusal = [&] { (void)solve_with_ipopt(program, options); };
  options.warm_start = PrimalDualPoint{.x = Eigen::Vector2d(1, 2)};
  EXPECT_EQ(message_of<InvalidInput>(refusal), "point: x has 2 entries; expected 4");
  options.warm_start = PrimalDualPoint{.x = program.variables_.start, .mu = -1.0};
  EXPECT_EQ(message_of<InvalidInput>(refusal),
            "ipopt: the warm start's mu is -1; expected a positive number, or 0 where it is not "
            "known");
  options.warm_start.reset();
  options.objective_scale = 0.0;
  EXPECT_EQ(message_of<InvalidInput>(refusal),
            "the objective's scale is 0; expected a positive number");
}

TEST(IpoptWarmStart, TakesAPointWithoutMultipliers) {
  Hs071 program;
  IpoptOptions options;
  options.warm_start = PrimalDualPoint{.x = Eigen::Vector4d(1.1, 4.5, 4.0, 1.4)};
  double first_objective = 0.0;
  options.on_iteration = [&](const IterationInfo& info) {
    if (info.iteration == 0) {
      first_objective = info.objective;
    }
    return true;
  };
  const IpoptResult result = solve_with_ipopt(program, options);
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_NEAR(first_objective, program.objective(options.warm_start->x), 1e-6);
}

}  // namespace
}  // namespace hbar::solvers
