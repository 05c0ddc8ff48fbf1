#include "hbar/core/base/hyper_dual.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "hbar/core/base/scalar.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using testing::Random;

struct HyperOperation {
  std::string name;
  std::function<HyperDual(HyperDual, HyperDual)> hyper;
  std::function<Dual(Dual, Dual)> dual;
  std::function<double(double, double)> plain;
};

template <typename Formula>
HyperOperation hyper_operation(std::string name, Formula formula) {
  return {std::move(name), formula, formula, formula};
}

std::vector<HyperOperation> every_hyper_operation() {
  using std::abs;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::pow;
  using std::sin;
  using std::sqrt;
  return {
      hyper_operation("a + b", [](auto a, auto b) { return a + b; }),
      hyper_operation("a - b", [](auto a, auto b) { return a - b; }),
      hyper_operation("a * b", [](auto a, auto b) { return a * b; }),
      hyper_operation("a / b", [](auto a, auto b) { return a / b; }),
      hyper_operation("-a", [](auto a, auto) { return -a; }),
      hyper_operation("+a", [](auto a, auto) { return +a; }),
      hyper_operation("a += b", [](auto a, auto b) { return a += b; }),
      hyper_operation("a -= b", [](auto a, auto b) { return a -= b; }),
      hyper_operation("a *= a", [](auto a, auto) { return a *= a; }),
      hyper_operation("a /= a b", [](auto a, auto b) { return a /= a * b; }),
      hyper_operation("a -= a", [](auto a, auto) { return a -= a; }),
      hyper_operation("2 - a", [](auto a, auto) { return 2.0 - a; }),
      hyper_operation("2 / a", [](auto a, auto) { return 2.0 / a; }),
      hyper_operation("sqrt", [](auto a, auto) { return sqrt(a * a + 1.0); }),
      hyper_operation("sin", [](auto a, auto b) { return sin(a * b); }),
      hyper_operation("cos", [](auto a, auto b) { return cos(a * b); }),
      hyper_operation("abs", [](auto a, auto b) { return abs(a * b); }),
      hyper_operation("exp", [](auto a, auto b) { return exp(a * b); }),
      hyper_operation("log", [](auto a, auto b) { return log(a * a + b * b); }),
      hyper_operation("pow 3", [](auto a, auto b) { return pow(a * b, 3.0); }),
      hyper_operation("pow -0.5", [](auto a, auto b) { return pow(a * a + b * b, -0.5); }),
      hyper_operation("pow b", [](auto a, auto b) { return pow(a * a + 0.5, b); }),
      hyper_operation("atan2", [](auto a, auto b) { return atan2(a, b); }),
      hyper_operation("atan2 of more", [](auto a, auto b) { return atan2(a * b, sin(a)); }),
  };
}

TEST(EveryHyperDualOperation, HasTheDerivativesOfTheOperationOnDuals) {
  Random random(1);
  for (const HyperOperation& op : every_hyper_operation()) {
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector2d x = random.vector(2, 2.0);
      const Eigen::Vector2d d = random.vector(2);
      const Eigen::Vector2d e = random.vector(2);
      const double curved = random.between(-1.0, 1.0);
      if (x.cwiseAbs().minCoeff() < 0.2) {
        continue;  // too near to a kink or a pole for differences
      }
      const HyperDual result = op.hyper({x[0], d[0], e[0], curved}, {x[1], d[1], e[1], 0.0});
      EXPECT_NEAR(result.value, op.plain(x[0], x[1]), 1e-15 * std::abs(result.value)) << op.name;
      EXPECT_NEAR(result.slope_1, op.dual({x[0], d[0]}, {x[1], d[1]}).slope,
                  1e-12 * (1.0 + std::abs(result.slope_1)))
          << op.name;
      EXPECT_NEAR(result.slope_2, op.dual({x[0], e[0]}, {x[1], e[1]}).slope,
                  1e-12 * (1.0 + std::abs(result.slope_2)))
          << op.name;
      // The dual slope along d, moved along e: d itself moves by `curved` in the first number.
      const auto slope_along = [&](const Eigen::VectorXd& s) -> Eigen::VectorXd {
        const Dual a(x[0] + s[0] * e[0], d[0] + s[0] * curved);
        const Dual b(x[1] + s[0] * e[1], d[1]);
        return Eigen::VectorXd::Constant(1, op.dual(a, b).slope);
      };
      const double cross = testing::differences(slope_along, Eigen::VectorXd::Zero(1), 1e-3)(0, 0);
      EXPECT_NEAR(result.cross, cross, 1e-7 * (1.0 + std::abs(cross))) << op.name << " at " << x;
    }
  }
}

TEST(HyperDual, HasPowersOfZero) {
  const HyperDual zero(0.0, 1.0, 1.0, 0.0);
  EXPECT_EQ(pow(zero, 0.0).cross, 0.0);
  EXPECT_EQ(pow(zero, 1.0).slope_1, 1.0);
  EXPECT_EQ(pow(zero, 1.0).cross, 0.0);
  EXPECT_EQ(pow(zero, 2.0).slope_1, 0.0);
  EXPECT_EQ(pow(zero, 2.0).cross, 2.0);
  EXPECT_EQ(pow(Dual(0.0, 1.0), 0.0).slope, 0.0);
  EXPECT_EQ(pow(Dual(0.0, 1.0), 1.0).slope, 1.0);
}

TEST(HyperDual, ComparesByValueAlone) {
  EXPECT_TRUE(HyperDual(1.0, 5.0, 1.0, 2.0) == HyperDual(1.0));
  EXPECT_TRUE(HyperDual(1.0, 5.0, 1.0, 2.0) < HyperDual(2.0));
  EXPECT_FALSE(HyperDual(testing::kNan) < 1.0);
  EXPECT_EQ(value_of(HyperDual(1.5, 2.5, 3.5, 4.5)), 1.5);
}

}  // namespace
}  // namespace hbar
