#include "hbar/solvers/newton/newton.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <limits>
#include <vector>

#include "tests/support/count_allocations.h"

namespace hbar::solvers {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// g and its Jacobian from functions; keeps the points at which the Jacobian was taken.
class ScriptedSystem final : public NewtonSystem {
 public:
  using G = std::function<void(const VectorXd&, VectorXd&)>;
  using J = std::function<void(const VectorXd&, MatrixXd&)>;

  ScriptedSystem(Eigen::Index size, G g, J jacobian)
      : g_(std::move(g)), jacobian_(std::move(jacobian)), matrix_(size, size), lu_(size) {}

  void residual(const VectorXd& x, VectorXd& g) override { g_(x, g); }
  void factorize(const VectorXd& x, VectorXd& g) override {
    g_(x, g);
    jacobian_(x, matrix_);
    lu_.compute(matrix_);
    ++factorizations;
  }
  void solve(const VectorXd& g, VectorXd& dx) override { dx = lu_.solve(g); }

  int factorizations = 0;

 private:
  G g_;
  J jacobian_;
  MatrixXd matrix_;
  Eigen::PartialPivLU<MatrixXd> lu_;
};

/// One equation in one unknown.
ScriptedSystem scalar_system(std::function<double(double)> g, std::function<double(double)> slope) {
  return {1, [g](const VectorXd& x, VectorXd& out) { out[0] = g(x[0]); },
          [slope](const VectorXd& x, MatrixXd& J) { J(0, 0) = slope(x[0]); }};
}

ScriptedSystem arc_tangent() {
  return scalar_system([](double x) { return std::atan(x); },
                       [](double x) { return 1.0 / (1.0 + x * x); });
}

/// 10 (x₁ − x₀²) and 1 − x₀, each times a scale of its own.
ScriptedSystem rosenbrock(double scale0 = 1.0, double scale1 = 1.0) {
  return {2,
          [=](const VectorXd& x, VectorXd& g) {
            g[0] = scale0 * 10.0 * (x[1] - x[0] * x[0]);
            g[1] = scale1 * (1.0 - x[0]);
          },
          [=](const VectorXd& x, MatrixXd& J) {
            J << -20.0 * scale0 * x[0], 10.0 * scale0, -scale1, 0.0;
          }};
}

/// A mass on a soft spring pushed against a stiff one that begins at 1: x − 5 + k max(0, x − 1).
ScriptedSystem stiff_spring(double k) {
  return scalar_system([k](double x) { return x - 5.0 + k * std::max(0.0, x - 1.0); },
                       [k](double x) { return 1.0 + (x > 1.0 ? k : 0.0); });
}

/// Iterates by running with 1, 2, … corrections allowed.
std::vector<double> errors_by_iteration(ScriptedSystem& system, const VectorXd& start,
                                        const VectorXd& root, int count) {
  std::vector<double> errors;
  for (int limit = 1; limit <= count; ++limit) {
    NewtonOptions options;
    options.max_iter = limit;
    VectorXd x = start;
    const NewtonReport report = Newton(x.size()).solve(system, options, x);
    errors.push_back((x - root).norm());
    EXPECT_LE(report.iterations, limit);
  }
  return errors;
}

TEST(Newton, ConvergesQuadratically) {
  // x³ = 8 from 2.5: the error constant is g''/2g' = 1/2 at the root.
  ScriptedSystem system =
      scalar_system([](double x) { return x * x * x - 8.0; }, [](double x) { return 3.0 * x * x; });
  const std::vector<double> errors =
      errors_by_iteration(system, VectorXd::Constant(1, 2.5), VectorXd::Constant(1, 2.0), 3);
  EXPECT_LT(errors[0], 0.5 * 0.5 * 0.5);
  EXPECT_LT(errors[1], 0.5 * errors[0] * errors[0]);
  EXPECT_LT(errors[2], errors[1] * errors[0]);  // a reused Jacobian may take this one
}

TEST(Newton, SolvesALinearSystemInOneCorrectionWithOneJacobian) {
  const MatrixXd A{{4.0, 1.0}, {2.0, 3.0}};
  ScriptedSystem system(
      2, [&](const VectorXd& x, VectorXd& g) { g = A * x - VectorXd::Ones(2); },
      [&](const VectorXd&, MatrixXd& J) { J = A; });
  VectorXd x = VectorXd::Constant(2, 1e3);
  const NewtonReport report = Newton(2).solve(system, {}, x);
  EXPECT_EQ(report.status, NewtonStatus::kConverged);
  EXPECT_EQ(report.factorizations, 1);
  EXPECT_LE(report.iterations, 2);
  EXPECT_LT((A * x - VectorXd::Ones(2)).norm(), 1e-14);
}

TEST(Newton, FindsTheRootOfTheArcTangentFromWhereFullStepsDiverge) {
  for (const double start : {1.5, 10.0, -300.0}) {
    ScriptedSystem system = arc_tangent();
    VectorXd x = VectorXd::Constant(1, start);
    const NewtonReport report = Newton(1).solve(system, {}, x);
    EXPECT_TRUE(report.converged()) << start << ": " << describe(report.status);
    EXPECT_LT(std::abs(x[0]), 1e-12) << start;
    EXPECT_LT(report.iterations, 20) << start;
  }
}

TEST(Newton, EveryAcceptedCorrectionIsShorterThanTheOneBefore) {
  // The natural monotonicity test: with one Jacobian the simplified correction shrinks.
  double previous = std::numeric_limits<double>::infinity();
  for (int limit = 1; limit <= 8; ++limit) {
    ScriptedSystem system = arc_tangent();
    NewtonOptions options;
    options.max_iter = limit;
    VectorXd x = VectorXd::Constant(1, 20.0);
    const NewtonReport report = Newton(1).solve(system, options, x);
    const double correction = std::abs(std::atan(x[0]) * (1.0 + x[0] * x[0]));
    EXPECT_LT(correction, previous) << limit << ": " << describe(report.status);
    previous = correction;
  }
}

TEST(Newton, SolvesRosenbrocksSystem) {
  ScriptedSystem system = rosenbrock();
  VectorXd x(2);
  x << -1.2, 1.0;
  const NewtonReport report = Newton(2).solve(system, {}, x);
  EXPECT_TRUE(report.converged()) << describe(report.status);
  EXPECT_LT((x - VectorXd::Ones(2)).norm(), 1e-14);
  EXPECT_LT(report.iterations, 30);
}

TEST(Newton, TakesTheSameStepsWhateverTheScaleOfEachEquation) {
  NewtonOptions options;
  options.tol = 1e300;  // the only measure that depends on the scale
  for (int limit = 1; limit <= 6; ++limit) {
    options.max_iter = limit;
    ScriptedSystem system = rosenbrock();
    ScriptedSystem scaled =
        rosenbrock(std::ldexp(1.0, 40), std::ldexp(1.0, -30));  // exact in binary
    VectorXd x(2);
    x << -1.2, 1.0;
    VectorXd x_scaled = x;
    const NewtonReport report = Newton(2).solve(system, options, x);
    const NewtonReport report_scaled = Newton(2).solve(scaled, options, x_scaled);
    EXPECT_LT((x - x_scaled).norm(), 1e-13 * x.norm()) << limit;
    EXPECT_EQ(report.iterations, report_scaled.iterations);
    EXPECT_EQ(report.factorizations, report_scaled.factorizations);
  }
}

TEST(Newton, ConvergesOnAStiffSpringFromFarAway) {
  constexpr double kStiffness = 1e8;
  const double root = (5.0 + kStiffness) / (1.0 + kStiffness);
  for (const double start : {0.0, 0.999999, 4.0, 1e6}) {
    ScriptedSystem system = stiff_spring(kStiffness);
    VectorXd x = VectorXd::Constant(1, start);
    const NewtonReport report = Newton(1).solve(system, {}, x);
    EXPECT_TRUE(report.converged()) << start << ": " << describe(report.status);
    EXPECT_NEAR(x[0], root, 1e-15) << start;
    EXPECT_LT(report.iterations, 40) << start;
  }
}

TEST(Newton, ReportsWhatItDid) {
  ScriptedSystem system = rosenbrock();
  VectorXd x(2);
  x << -1.2, 1.0;
  const NewtonReport report = Newton(2).solve(system, {}, x);
  EXPECT_EQ(report.factorizations, system.factorizations);
  EXPECT_GE(report.iterations, report.factorizations);
  EXPECT_LE(report.residual, NewtonOptions{}.tol);
  EXPECT_LE(report.correction, 1e-6);
}

TEST(Newton, NamesTheCoordinateThatMovesMost) {
  ScriptedSystem system(
      3, [](const VectorXd& x, VectorXd& g) { g = x - VectorXd::Unit(3, 1) * 1e3; },
      [](const VectorXd&, MatrixXd& J) { J.setIdentity(); });
  NewtonOptions options;
  options.max_iter = 1;
  options.tol = 0.0;
  VectorXd x = VectorXd::Zero(3);
  const NewtonReport report = Newton(3).solve(system, options, x);
  EXPECT_EQ(report.worst, 1);
}

TEST(Newton, StopsAtTheIterationLimit) {
  ScriptedSystem system = rosenbrock();
  NewtonOptions options;
  options.max_iter = 2;
  VectorXd x(2);
  x << -12.0, 100.0;
  const NewtonReport report = Newton(2).solve(system, options, x);
  EXPECT_EQ(report.status, NewtonStatus::kIterationLimit);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_FALSE(report.converged());
}

TEST(Newton, StallsWhereThereIsNoRoot) {
  // From 0.5 by way of -0.25 to 0.0625, where an eighth of the step is still too long.
  ScriptedSystem system = scalar_system([](double x) { return 1.0 + std::abs(x); },
                                        [](double x) { return x < 0.0 ? -1.0 : 1.0; });
  NewtonOptions options;
  options.max_ls = 3;
  VectorXd x = VectorXd::Constant(1, 0.5);
  const NewtonReport report = Newton(1).solve(system, options, x);
  EXPECT_EQ(report.status, NewtonStatus::kLineSearch);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_FALSE(report.converged());
}

TEST(Newton, SaysThatAJacobianIsSingular) {
  ScriptedSystem system =
      scalar_system([](double x) { return x * x - 1.0; }, [](double x) { return 2.0 * x; });
  VectorXd x = VectorXd::Zero(1);
  const NewtonReport report = Newton(1).solve(system, {}, x);
  EXPECT_EQ(report.status, NewtonStatus::kSingular);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x[0], 0.0);
}

TEST(Newton, SaysThatAResidualIsNotFinite) {
  ScriptedSystem system =
      scalar_system([](double x) { return std::log(x); }, [](double x) { return 1.0 / x; });
  VectorXd x = VectorXd::Constant(1, -1.0);
  const NewtonReport report = Newton(1).solve(system, {}, x);
  EXPECT_EQ(report.status, NewtonStatus::kNotFinite);
  EXPECT_FALSE(report.converged());
}

TEST(Newton, ShortensACorrectionThatLeavesTheResidualsDomain) {
  ScriptedSystem system =
      scalar_system([](double x) { return std::log(x); }, [](double x) { return 1.0 / x; });
  VectorXd x = VectorXd::Constant(1, 5.0);  // the full step leads to 5 − 5 log 5 < 0
  const NewtonReport report = Newton(1).solve(system, {}, x);
  EXPECT_TRUE(report.converged()) << describe(report.status);
  EXPECT_NEAR(x[0], 1.0, 1e-12);
}

TEST(Newton, ConvergesToRoundingWhereTheToleranceCannotBeReached) {
  ScriptedSystem system = scalar_system([](double x) { return 1e10 * (std::exp(x) - 3.0); },
                                        [](double x) { return 1e10 * std::exp(x); });
  NewtonOptions options;
  options.tol = 1e-30;
  VectorXd x = VectorXd::Constant(1, 2.0);
  const NewtonReport report = Newton(1).solve(system, options, x);
  EXPECT_EQ(report.status, NewtonStatus::kRounding);
  EXPECT_TRUE(report.converged());
  EXPECT_NEAR(x[0], std::log(3.0), 1e-15);
}

TEST(Newton, DescribesEveryStatus) {
  EXPECT_EQ(describe(NewtonStatus::kConverged), "converged");
  EXPECT_EQ(describe(NewtonStatus::kRounding), "converged to rounding");
  EXPECT_EQ(describe(NewtonStatus::kIterationLimit), "iteration limit reached");
  EXPECT_EQ(describe(NewtonStatus::kLineSearch), "line search stalled");
  EXPECT_EQ(describe(NewtonStatus::kSingular), "singular Jacobian");
  EXPECT_EQ(describe(NewtonStatus::kNotFinite), "residual not finite");
  EXPECT_EQ(describe(NewtonStatus::kStrayed), "converged to a root far from the prediction");
}

#if HBAR_COUNTS_MALLOC  // not under sanitizers, which own malloc
TEST(Newton, AllocatesNothing) {
  ScriptedSystem system = rosenbrock();
  Newton newton(2);
  const NewtonOptions options;
  VectorXd x(2);
  const auto solve = [&] {
    x << -1.2, 1.0;
    EXPECT_TRUE(newton.solve(system, options, x).converged());
  };
  EXPECT_GT(hbar::testing::allocations_of([] { EXPECT_EQ(VectorXd::Ones(3).eval().size(), 3); }),
            0U);
  EXPECT_EQ(hbar::testing::allocations_of(solve), 0U);
}
#endif

}  // namespace
}  // namespace hbar::solvers
