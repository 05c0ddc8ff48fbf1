#include "hbar/solvers/nlp/scaled_nlp.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kInfinity;
using testing::message_of;

class ScaledHs071 : public ::testing::Test {
 protected:
  ScaledHs071() {
    program_.variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
    program_.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  }
  Hs071 program_;
};

// Derivatives of the scaled values are the scaled derivatives: differences of one prove the other.
TEST_F(ScaledHs071, DerivativesAreThoseOfItsValues) {
  ScaledNlp scaled(program_, 1e-6, 7.0, HessianKind::kExact);
  const Eigen::Vector4d x =
      Eigen::Vector4d(1.3, 4.1, 3.2, 1.7).cwiseQuotient(program_.variables_.scale);
  const Eigen::Vector2d lambda(0.4, -0.7);
  Eigen::VectorXd g(4);
  Eigen::VectorXd jacobian(8);
  Eigen::VectorXd hessian(10);
  ASSERT_TRUE(scaled.scaled_gradient(x, g));
  ASSERT_TRUE(scaled.scaled_jacobian(x, jacobian));
  ASSERT_TRUE(scaled.scaled_hessian(x, 1.5, lambda, hessian));
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(4, 4);
  for (std::size_t k = 0; k < 10; ++k) {
    const int row = scaled.hessian_pattern().rows[k];
    const int column = scaled.hessian_pattern().columns[k];
    H(row, column) = H(column, row) = hessian[static_cast<Eigen::Index>(k)];
  }
  const auto lagrangian_gradient = [&](const Eigen::Vector4d& at) {
    Eigen::VectorXd gradient(4);
    Eigen::VectorXd entries(8);
    EXPECT_TRUE(scaled.scaled_gradient(at, gradient) && scaled.scaled_jacobian(at, entries));
    return Eigen::VectorXd(1.5 * gradient + lambda[0] * entries.head(4) +
                           lambda[1] * entries.tail(4));
  };
  const double step = 1e-5;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d d = step * Eigen::Vector4d::Unit(i);
    double above = 0.0;
    double below = 0.0;
    Eigen::VectorXd c_above(2);
    Eigen::VectorXd c_below(2);
    ASSERT_TRUE(scaled.scaled_objective(x + d, above) && scaled.scaled_constraints(x + d, c_above));
    ASSERT_TRUE(scaled.scaled_objective(x - d, below) && scaled.scaled_constraints(x - d, c_below));
    EXPECT_NEAR((above - below) / (2.0 * step), g[i], 1e-8);
    EXPECT_NEAR((c_above - c_below)[0] / (2.0 * step), jacobian[i], 1e-8);
    EXPECT_NEAR((c_above - c_below)[1] / (2.0 * step), jacobian[4 + i], 1e-8);
    const Eigen::VectorXd slope =
        (lagrangian_gradient(x + d) - lagrangian_gradient(x - d)) / (2.0 * step);
    EXPECT_LT((slope - H.col(i)).norm(), 1e-8);
  }
}

TEST_F(ScaledHs071, LimitsAreDividedByTheirScales) {
  const ScaledNlp scaled(program_, 1e-6, 1.0);
  EXPECT_EQ(scaled.scaled_lower(), Eigen::Vector4d(2.0, 1.0 / 3.0, 0.5, 0.25));
  EXPECT_EQ(scaled.scaled_constraint_lower(), Eigen::Vector2d(5.0, 2.0));
  EXPECT_EQ(scaled.scaled_constraint_upper(), Eigen::Vector2d(kInfinity, 2.0));
  EXPECT_TRUE(scaled.hessian_pattern().rows.empty());
}

TEST_F(ScaledHs071, PointsReturnAsTheyCameAndLagrangiansAgree) {
  ScaledNlp scaled(program_, 1e-6, 7.0);
  const PrimalDualPoint point{Eigen::Vector4d(1.3, 4.1, 3.2, 1.7), Eigen::Vector2d(0.4, -0.7),
                              Eigen::Vector4d(1, 2, 3, 4), Eigen::Vector4d(4, 3, 2, 1), 1e-5};
  const PrimalDualPoint inside = scaled.scaled(point);
  const PrimalDualPoint back = scaled.unscaled(inside);
  EXPECT_LT((back.x - point.x).norm(), 1e-15);
  EXPECT_LT((back.constraint_multipliers - point.constraint_multipliers).norm(), 1e-15);
  EXPECT_LT((back.lower_multipliers - point.lower_multipliers).norm(), 1e-14);
  EXPECT_LT((back.upper_multipliers - point.upper_multipliers).norm(), 1e-14);
  EXPECT_EQ(back.mu, point.mu);
  // L = f + λᵀ c − z_Lᵀ (x − l), over the objective's scale.
  Eigen::VectorXd c(2);
  program_.constraints(point.x, c);
  const double lagrangian = program_.objective(point.x) + point.constraint_multipliers.dot(c) -
                            point.lower_multipliers.dot(point.x - program_.variables_.lower);
  double f = 0.0;
  Eigen::VectorXd scaled_c(2);
  ASSERT_TRUE(scaled.scaled_objective(inside.x, f));
  ASSERT_TRUE(scaled.scaled_constraints(inside.x, scaled_c));
  EXPECT_NEAR(f + inside.constraint_multipliers.dot(scaled_c) -
                  inside.lower_multipliers.dot(inside.x - scaled.scaled_lower()),
              lagrangian / 7.0, 1e-13);
}

TEST_F(ScaledHs071, MovesPointsIntoTheirBoundsAndRefusesOthers) {
  const ScaledNlp scaled(program_, 1e-6, 1.0);
  const PrimalDualPoint inside = scaled.scaled({.x = Eigen::Vector4d(0.0, 9.0, 3.0, 2.0)});
  EXPECT_EQ(inside.x, Eigen::Vector4d(2.0, 5.0 / 3.0, 1.5, 0.5));
  EXPECT_EQ(inside.constraint_multipliers, Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(message_of<InvalidInput>([&] {
              (void)scaled.scaled({.x = inside.x, .upper_multipliers = Eigen::Vector3d::Zero()});
            }),
            "point: upper_multipliers has 3 entries; expected 4");
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)scaled.scaled({.x = Eigen::Vector4d(1, 2, kInfinity, 1)}); }),
            "point: entry 2 of x is inf; expected a finite number");
}

TEST(ScaleFromBounds, IsHalfTheRangeOrTheStart) {
  const Eigen::Vector4d lower(-1.0, 0.0, -kInfinity, 2.0);
  const Eigen::Vector4d upper(3.0, kInfinity, kInfinity, 2.0);
  EXPECT_EQ(scale_from_bounds(lower, upper, Eigen::Vector4d(0.0, 0.5, -7.0, 2.0)),
            Eigen::Vector4d(2.0, 1.0, 7.0, 2.0));
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)scale_from_bounds(lower, upper, Eigen::Vector2d(0, 0)); }),
            "scale_from_bounds: 4 lower and 4 upper bounds for 2 variables");
}

}  // namespace
}  // namespace hbar::solvers
