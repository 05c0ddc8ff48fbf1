#include "hbar/core/base/scalar.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using testing::Random;
using testing::relative_gap;
using testing::slopes;
using testing::values;
using testing::with_slope;

struct Operation {
  std::string name;
  std::function<Dual(Dual, Dual)> dual;
  std::function<double(double, double)> plain;
};

template <typename Formula>
Operation operation(std::string name, Formula formula) {
  return {std::move(name), formula, formula};
}

std::vector<Operation> every_operation() {
  using std::abs;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::pow;
  using std::sin;
  using std::sqrt;
  return {
      operation("a + b", [](auto a, auto b) { return a + b; }),
      operation("a - b", [](auto a, auto b) { return a - b; }),
      operation("a * b", [](auto a, auto b) { return a * b; }),
      operation("a / b", [](auto a, auto b) { return a / b; }),
      operation("-a", [](auto a, auto) { return -a; }),
      operation("+a", [](auto a, auto) { return +a; }),
      operation("a += b", [](auto a, auto b) { return a += b; }),
      operation("a -= b", [](auto a, auto b) { return a -= b; }),
      operation("a *= b", [](auto a, auto b) { return a *= b; }),
      operation("a /= b", [](auto a, auto b) { return a /= b; }),
      operation("a *= a", [](auto a, auto) { return a *= a; }),
      operation("a /= a b", [](auto a, auto b) { return a /= a * b; }),
      operation("2 + a", [](auto a, auto) { return 2.0 + a; }),
      operation("2 - a", [](auto a, auto) { return 2.0 - a; }),
      operation("a * 2", [](auto a, auto) { return a * 2.0; }),
      operation("2 / a", [](auto a, auto) { return 2.0 / a; }),
      operation("sqrt a", [](auto a, auto) { return sqrt(a * a + 1.0); }),
      operation("sin a", [](auto a, auto) { return sin(a); }),
      operation("cos a", [](auto a, auto) { return cos(a); }),
      operation("abs a", [](auto a, auto) { return abs(a); }),
      operation("exp a", [](auto a, auto) { return exp(a); }),
      operation("log a", [](auto a, auto) { return log(a * a + 1.0); }),
      operation("a to the 3", [](auto a, auto) { return pow(a, 3.0); }),
      operation("a to the -1.5", [](auto a, auto) { return pow(a * a + 1.0, -1.5); }),
      operation("a to the b", [](auto a, auto b) { return pow(a * a + 1.0, b); }),
      operation("atan2", [](auto a, auto b) { return atan2(a, b); }),
      operation("a formula", [](auto a, auto b) { return sin(a * b) / sqrt(b * b) - cos(a) * b; }),
  };
}

TEST(EveryDualOperation, HasTheValueAndTheDerivativeOfTheOperationOnDoubles) {
  Random random(1);
  for (const Operation& op : every_operation()) {
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector2d x = random.vector(2, 2.0) + Eigen::Vector2d::Constant(0.01);
      const Eigen::Vector2d d = random.vector(2);
      if (x.cwiseAbs().minCoeff() < 0.05) {
        continue;  // too near to a kink or a pole for differences
      }
      const Dual result = op.dual({x[0], d[0]}, {x[1], d[1]});
      EXPECT_EQ(result.value, op.plain(x[0], x[1])) << op.name;
      const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, op.plain(x[0] + e[0] * d[0], x[1] + e[0] * d[1]));
      };
      const double slope = testing::differences(along, Eigen::VectorXd::Zero(1), 1e-3)(0, 0);
      EXPECT_NEAR(result.slope, slope, 1e-7 * (1.0 + std::abs(slope))) << op.name << " at " << x;
    }
  }
}

TEST(Dual, ComparesByValueAlone) {
  EXPECT_TRUE(Dual(1.0, 5.0) == Dual(1.0, -5.0));
  EXPECT_TRUE(Dual(1.0, 5.0) < Dual(2.0, 0.0));
  EXPECT_TRUE(Dual(2.0, 0.0) >= 1.0);
  EXPECT_TRUE(Dual(2.0, 9.0) != Dual(1.0, 9.0));
  EXPECT_FALSE(Dual(std::nan("")) < 1.0);
  EXPECT_FALSE(Dual(std::nan("")) >= 1.0);
}

TEST(Dual, ValueOfDropsTheDerivative) {
  EXPECT_EQ(value_of(Dual(1.5, 2.5)), 1.5);
  EXPECT_EQ(value_of(1.5), 1.5);
}

TEST(Dual, DifferentiatesMatrixProductsAndSolutionsInsideEigen) {
  Random random(2);
  const Eigen::MatrixXd A = random.matrix(5, 5) + 3.0 * Eigen::MatrixXd::Identity(5, 5);
  const Eigen::MatrixXd dA = random.matrix(5, 5);
  const Eigen::MatrixXd B = random.matrix(5, 2);
  const Eigen::MatrixXd dB = random.matrix(5, 2);
  const auto A_dual = with_slope(A, dA);
  const auto B_dual = with_slope(B, dB);

  const MatrixX<Dual> product = A_dual * B_dual;
  EXPECT_LT(relative_gap(values(product), A * B), 1e-15);
  EXPECT_LT(relative_gap(slopes(product), dA * B + A * dB), 1e-15);

  const MatrixX<Dual> X = A_dual.partialPivLu().solve(B_dual);
  const Eigen::MatrixXd expected = A.partialPivLu().solve(B);
  EXPECT_LT(relative_gap(values(X), expected), 1e-14);
  EXPECT_LT(relative_gap(slopes(X), A.partialPivLu().solve(dB - dA * expected)), 1e-14);
}

TEST(Dual, MixesWithDoublesInsideEigen) {
  Random random(3);
  const Eigen::MatrixXd A = random.matrix(4, 4);
  const Eigen::VectorXd x = random.vector(4);
  const Eigen::VectorXd d = random.vector(4);
  const VectorX<Dual> y = A * with_slope(x, d);
  EXPECT_LT(relative_gap(values(y), A * x), 1e-15);
  EXPECT_LT(relative_gap(slopes(y), A * d), 1e-15);
  const Dual norm = with_slope(x, d).norm();
  EXPECT_NEAR(norm.slope, x.dot(d) / x.norm(), 1e-15);
}

}  // namespace
}  // namespace hbar
