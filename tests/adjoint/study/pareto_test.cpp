#include "hbar/adjoint/study/pareto.h"

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/numerics.h"
#include "tests/support/programs.h"

namespace hbar::study {
namespace {

constexpr int kSize = 6;

/// w f1 + (1 − w) f2 with f1 = Σ (x_i − 1)² and f2 = Σ (e^{x_i} − x_i − 1). At an optimum all x_i
/// are equal, so that the front is f2 = n (e^x − x − 1) with x = 1 − √(f1/n).
class WeightedSum : public solvers::testing::Program {
 public:
  explicit WeightedSum(double weight)
      : Program(Eigen::VectorXd::LinSpaced(kSize, -2.0, 3.0), 0), weight_(weight) {}

  static double f1(const Eigen::VectorXd& x) { return (x.array() - 1.0).square().sum(); }
  static double f2(const Eigen::VectorXd& x) { return (x.array().exp() - x.array() - 1.0).sum(); }
  double objective(const Eigen::VectorXd& x) override {
    return weight_ * f1(x) + (1.0 - weight_) * f2(x);
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    g = 2.0 * weight_ * (x.array() - 1.0) + (1.0 - weight_) * (x.array().exp() - 1.0);
  }
  void constraints(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd&) override {}

 private:
  double weight_;
};

/// Solves with Ipopt, and counts its iterations.
WeightedSolve ipopt_solve(bool warm_starts, int& iterations) {
  return [=, &iterations](double weight, const solvers::PrimalDualPoint* warm) {
    WeightedSum program(weight);
    solvers::IpoptOptions options;
    options.tolerance = 1e-9;
    if (warm != nullptr && warm_starts) {
      options.warm_start = *warm;
    }
    const solvers::IpoptResult result = solve_with_ipopt(program, options);
    iterations += result.iterations;
    return WeightedOptimum{.converged = result.converged(),
                           .f1 = WeightedSum::f1(result.x),
                           .f2 = WeightedSum::f2(result.x),
                           .point = result.point(),
                           .message = result.message};
  };
}

TEST(Pareto, SweepFindsTheKnownFrontInFewerIterationsWhenWarm) {
  int warm = 0;
  int cold = 0;
  const std::vector<ParetoPoint> points = pareto_sweep(equal_weights(11), ipopt_solve(true, warm));
  (void)pareto_sweep(equal_weights(11), ipopt_solve(false, cold));
  EXPECT_GT(warm, 0);
  EXPECT_LT(3 * warm, 2 * cold);
  ASSERT_EQ(points.size(), 11U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WeightedOptimum& optimum = points[i].optimum;
    ASSERT_TRUE(optimum.converged) << optimum.message;
    EXPECT_FALSE(points[i].dominated);
    EXPECT_NEAR(points[i].weight, 1.0 - static_cast<double>(i) / 10.0, 1e-15);
    const double x = 1.0 - std::sqrt(optimum.f1 / kSize);
    EXPECT_NEAR(optimum.f2, kSize * (std::exp(x) - x - 1.0), 1e-6);
    EXPECT_NEAR(2.0 * points[i].weight * (x - 1.0), -(1.0 - points[i].weight) * (std::exp(x) - 1.0),
                1e-6);
  }
}

TEST(Pareto, SweepMarksWhatIsDominatedAndKeepsWhatFails) {
  const std::vector<double> weights = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
  std::vector<double> started_from;
  const WeightedSolve solve = [&](double weight, const solvers::PrimalDualPoint* warm) {
    started_from.push_back(warm != nullptr ? warm->x[0] : -1.0);
    WeightedOptimum optimum{
        .converged = true, .f1 = 1.0 - weight, .f2 = weight, .point = {}, .message = {}};
    optimum.point.x = Eigen::VectorXd::Constant(1, weight);
    if (weight == 0.2) {
      throw NumericalFailure("no step");
    }
    if (weight == 0.4) {
      optimum.f2 = 0.9;  // worse than 0.8 in both
    }
    if (weight == 0.6) {
      optimum.f1 = testing::kNan;
    }
    return optimum;
  };
  const std::vector<ParetoPoint> points = pareto_sweep(weights, solve);
  EXPECT_EQ(started_from, (std::vector<double>{-1.0, 0.0, 0.0, 0.4, 0.4, 0.8}));
  std::vector<double> order;
  std::vector<bool> dominated;
  for (const ParetoPoint& point : points) {
    order.push_back(point.weight);
    dominated.push_back(point.dominated);
  }
  EXPECT_EQ(order, (std::vector<double>{1.0, 0.8, 0.4, 0.0, 0.2, 0.6}));
  EXPECT_EQ(dominated, (std::vector<bool>{false, false, true, false, false, false}));
  EXPECT_FALSE(points[4].optimum.converged);
  EXPECT_EQ(points[4].optimum.message, "no step");
  EXPECT_FALSE(points[5].optimum.converged);
  EXPECT_EQ(points[5].optimum.f1, 0.0);
}

TEST(Pareto, SweepDoesNotCallEqualPointsDominated) {
  const auto same = [](double, const solvers::PrimalDualPoint*) {
    return WeightedOptimum{.converged = true, .f1 = 1.0, .f2 = 2.0};
  };
  for (const ParetoPoint& point : pareto_sweep({0.3, 0.1}, same)) {
    EXPECT_FALSE(point.dominated);
  }
}

TEST(Pareto, SweepRefusesWeightsThatAreNone) {
  int iterations = 0;
  EXPECT_THROW((void)pareto_sweep({}, ipopt_solve(true, iterations)), InvalidInput);
  EXPECT_THROW((void)pareto_sweep({1.5}, ipopt_solve(true, iterations)), InvalidInput);
  EXPECT_THROW((void)pareto_sweep({testing::kNan}, ipopt_solve(true, iterations)), InvalidInput);
  EXPECT_THROW((void)equal_weights(1), InvalidInput);
  EXPECT_EQ(iterations, 0);
}

}  // namespace
}  // namespace hbar::study
