#include "hbar/solvers/nlp/sensitivity.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::kInfinity;
using testing::message_of;

constexpr double kTheta = 0.8;
constexpr double kPhi = 0.3;

/// (x0 − θ)²/2 + (x1 − θ²)²/2 with x0 + x1 = 1 + φ and x1 ≤ u; variables x0, x1, θ, φ.
class Parabola : public testing::CurvedProgram {
 public:
  explicit Parabola(double u) : CurvedProgram(Eigen::Vector4d(0.0, 0.0, kTheta, kPhi), 1) {
    variables_.lower.tail(2) << kTheta, kPhi;
    variables_.upper << kInfinity, u, kTheta, kPhi;
    limits_.lower.setConstant(1.0);
    limits_.upper.setConstant(1.0);
  }
  double objective(const Eigen::VectorXd& x) override {
    return 0.5 * std::pow(x[0] - x[2], 2) + 0.5 * std::pow(x[1] - x[2] * x[2], 2);
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    const double a = x[0] - x[2];
    const double b = x[1] - x[2] * x[2];
    g << a, b, -a - 2.0 * x[2] * b, 0.0;
  }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override {
    c << x[0] + x[1] - x[3];
  }
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd& values) override {
    values << 1.0, 1.0, 0.0, -1.0;
  }
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd&,
                          HessianKind, Eigen::VectorXd& values) override {
    const double b = x[1] - x[2] * x[2];
    values << 1.0, 0.0, 1.0 - flat, -1.0, -2.0 * x[2], 1.0 - 2.0 * b + 4.0 * x[2] * x[2], 0.0, 0.0,
        0.0, 0.0;
    values *= sigma;
  }
  double flat = 0.0;  ///< takes curvature away along x1
};

// λ = (θ + θ² − 1 − φ) / 2, x0 = θ − λ, x1 = θ² − λ, f = λ².
constexpr double kLambda = 0.5 * (kTheta + kTheta * kTheta - 1.0 - kPhi);

PrimalDualPoint free_optimum() {
  PrimalDualPoint point;
  point.x = Eigen::Vector4d(kTheta - kLambda, kTheta * kTheta - kLambda, kTheta, kPhi);
  point.constraint_multipliers.setConstant(1, kLambda);
  return point;
}

TEST(Sensitivity, IsTheAnalyticOneWhateverTheScale) {
  Parabola program(kInfinity);
  for (const bool scaled : {false, true}) {
    SensitivityOptions options;
    if (scaled) {
      program.variables_.scale = Eigen::Vector4d(0.1, 20.0, 3.0, 0.5);
      program.limits_.scale = Eigen::VectorXd::Constant(1, 7.0);
      options.objective_scale = 4.0;
    }
    const Sensitivity s = sensitivity_of_optimum(program, free_optimum(), {2, 3}, options);
    const Eigen::MatrixXd dx =
        (Eigen::MatrixXd(4, 2) << 0.5 - kTheta, 0.5, kTheta - 0.5, 0.5, 1, 0, 0, 1).finished();
    EXPECT_LT((s.dx_dtheta - dx).norm(), 1e-14);
    EXPECT_LT((s.dlambda_dtheta - Eigen::RowVector2d(0.5 + kTheta, -0.5)).norm(), 1e-14);
    EXPECT_LT((s.df_dtheta - Eigen::Vector2d(kLambda * (1.0 + 2.0 * kTheta), -kLambda)).norm(),
              1e-14);
    EXPECT_TRUE(s.weakly_active.empty());
    EXPECT_EQ(s.held.variables, (std::vector{Activity::kInactive, Activity::kInactive,
                                             Activity::kEqual, Activity::kEqual}));
  }
}

TEST(Sensitivity, TakesParametersInTheOrderGiven) {
  Parabola program(kInfinity);
  const Sensitivity both = sensitivity_of_optimum(program, free_optimum(), {2, 3});
  const Sensitivity swapped = sensitivity_of_optimum(program, free_optimum(), {3, 2});
  EXPECT_EQ(both.dx_dtheta.col(0), swapped.dx_dtheta.col(1));
  EXPECT_EQ(both.df_dtheta[1], swapped.df_dtheta[0]);
}

TEST(Sensitivity, HoldsActiveBounds) {
  // x1 = u, x0 = 1 + φ − u, λ = θ − x0, z_U = −(u − θ² + λ), f = (x0 − θ)²/2 + (u − θ²)²/2.
  const double u = 0.5;
  Parabola program(u);
  const double x0 = 1.0 + kPhi - u;
  const double lambda = kTheta - x0;
  PrimalDualPoint point;
  point.x = Eigen::Vector4d(x0, u, kTheta, kPhi);
  point.constraint_multipliers.setConstant(1, lambda);
  point.upper_multipliers = Eigen::Vector4d(0.0, -(u - kTheta * kTheta + lambda), 0.0, 0.0);
  ASSERT_GT(point.upper_multipliers[1], 0.1);
  const Sensitivity s = sensitivity_of_optimum(program, point, {2, 3});
  EXPECT_EQ(s.held.variables[1], Activity::kUpper);
  const Eigen::MatrixXd dx = (Eigen::MatrixXd(4, 2) << 0, 1, 0, 0, 1, 0, 0, 1).finished();
  EXPECT_LT((s.dx_dtheta - dx).norm(), 1e-14);
  EXPECT_LT((s.dlambda_dtheta - Eigen::RowVector2d(1.0, -1.0)).norm(), 1e-14);
  const double b = u - kTheta * kTheta;
  EXPECT_LT((s.df_dtheta - Eigen::Vector2d(-(x0 - kTheta) - 2.0 * kTheta * b, x0 - kTheta)).norm(),
            1e-14);
}

TEST(Sensitivity, ReportsWeaklyActiveBounds) {
  Parabola program(kTheta * kTheta - kLambda);  // touched, but not needed
  const Sensitivity s = sensitivity_of_optimum(program, free_optimum(), {2});
  EXPECT_EQ(s.weakly_active, std::vector<std::string>{"x1"});
  EXPECT_NEAR(s.dx_dtheta(1, 0), kTheta - 0.5, 1e-14);
}

TEST(Sensitivity, ReleasesConstraintsThatDoNotHold) {
  Parabola program(kInfinity);
  program.limits_.lower.setConstant(-5.0);
  program.limits_.upper.setConstant(5.0);
  PrimalDualPoint point;
  point.x = Eigen::Vector4d(kTheta, kTheta * kTheta, kTheta, kPhi);
  point.constraint_multipliers.setConstant(1, 1e-9);
  const Sensitivity s = sensitivity_of_optimum(program, point, {2});
  EXPECT_LT((s.dx_dtheta.col(0) - Eigen::Vector4d(1.0, 2.0 * kTheta, 1.0, 0.0)).norm(), 1e-14);
  EXPECT_EQ(s.dlambda_dtheta(0, 0), 0.0);
  EXPECT_NEAR(s.df_dtheta[0], 0.0, 1e-14);
}

TEST(Sensitivity, RefusesSingularSystemsAndOtherPoints) {
  Parabola program(kInfinity);
  program.flat = 2.0;  // curvature 1 − 1 along x0 = −x1, where the constraint leaves it free
  const std::string singular = message_of<NumericalFailure>(
      [&] { (void)sensitivity_of_optimum(program, free_optimum(), {2}); });
  EXPECT_EQ(singular.find("sensitivity: the KKT matrix is singular ("), 0U) << singular;
  EXPECT_NE(singular.find("Lagrangian is flat"), std::string::npos) << singular;

  program.flat = 0.0;
  PrimalDualPoint point = free_optimum();
  point.constraint_multipliers *= 2.0;
  EXPECT_EQ(message_of<NumericalFailure>([&] {
              (void)sensitivity_of_optimum(program, point, {2});
            }).find("sensitivity: the point is no optimum: the Lagrangian's gradient by x0 is "),
            0U);
  point.x[0] += 0.5;
  EXPECT_EQ(
      message_of<NumericalFailure>([&] { (void)sensitivity_of_optimum(program, point, {2}); }),
      "sensitivity: the point is no optimum: c0 is violated by 0.5");
}

TEST(Sensitivity, RefusesParametersThatAreNotFixed) {
  Parabola program(kInfinity);
  const auto refusal = [&](const std::vector<int>& theta) {
    return message_of<InvalidInput>(
        [&] { (void)sensitivity_of_optimum(program, free_optimum(), theta); });
  };
  EXPECT_EQ(refusal({0}),
            "sensitivity: variable 0 (x0) is not fixed; expected lower = upper for every entry of "
            "theta");
  EXPECT_EQ(refusal({4}), "sensitivity: theta names variable 4; there are 4, counted from 0");
  EXPECT_EQ(refusal({2, 2}), "sensitivity: theta names variable 2 (x2) twice");
}

}  // namespace
}  // namespace hbar::solvers
