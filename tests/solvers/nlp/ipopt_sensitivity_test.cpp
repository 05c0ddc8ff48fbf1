#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/sensitivity.h"
#include "tests/support/programs.h"

namespace hbar::solvers {
namespace {

/// Hock and Schittkowski 71 with x2 fixed.
class FixedHs071 : public testing::Hs071 {
 public:
  explicit FixedHs071(double value) {
    variables_.start[2] = variables_.lower[2] = variables_.upper[2] = value;
    variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
    limits_.scale = Eigen::Vector2d(5.0, 20.0);
  }
  [[nodiscard]] IpoptResult solve() {
    return solve_with_ipopt(*this, {.tolerance = 1e-11, .hessian = HessianKind::kExact});
  }
};

TEST(IpoptSensitivity, IsTheDifferenceOfOptimaSolvedAnew) {
  const double value = 3.5;
  const double step = 1e-3;
  FixedHs071 program(value);
  const IpoptResult optimum = program.solve();
  ASSERT_TRUE(optimum.converged()) << optimum.message;
  const Sensitivity s = sensitivity_of_optimum(program, optimum.point(), {2});
  EXPECT_EQ(s.held.variables[0], Activity::kLower);
  EXPECT_EQ(s.held.constraints[0], Activity::kLower);
  const IpoptResult above = FixedHs071(value + step).solve();
  const IpoptResult below = FixedHs071(value - step).solve();
  ASSERT_TRUE(above.converged() && below.converged());
  const auto slope = [&](const auto& a, const auto& b) { return (a - b) / (2.0 * step); };
  EXPECT_LT((s.dx_dtheta.col(0) - slope(above.x, below.x)).norm(), 1e-5);
  EXPECT_LT(
      (s.dlambda_dtheta.col(0) - slope(above.constraint_multipliers, below.constraint_multipliers))
          .norm(),
      1e-4);
  EXPECT_NEAR(s.df_dtheta[0], slope(above.objective, below.objective), 1e-5);
  EXPECT_GT(s.dx_dtheta.col(0).norm(), 1.2) << "it moves at all";
}

}  // namespace
}  // namespace hbar::solvers
