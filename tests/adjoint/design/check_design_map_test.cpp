#include "hbar/adjoint/design/check_design_map.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// p = (d₀ d₁, d₀³), with an error in one entry of its Jacobian.
class Products : public DesignMap {
 public:
  explicit Products(double error) : error_(error) {
    variables_ = {{"a", "b"},
                  {"", ""},
                  Eigen::Vector2d(2.0, 3.0),
                  Eigen::Vector2d::Zero(),
                  Eigen::Vector2d::Constant(10.0),
                  Eigen::Vector2d::Ones()};
  }
  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return 2; }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override {
    return Eigen::Vector2d(d[0] * d[1], d[0] * d[0] * d[0]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override {
    Eigen::Matrix2d J;
    J << d[1], d[0] * (1.0 + error_), 3.0 * d[0] * d[0], 0.0;
    return J;
  }

 private:
  DesignVariables variables_;
  double error_;
};

/// The same with a Hessian, which has an error in one entry.
class CurvedProducts final : public Products {
 public:
  explicit CurvedProducts(double error) : Products(0.0), error_(error) {}
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd& y) const override {
    Eigen::Matrix2d H;
    H << 6.0 * d[0] * y[1], y[0], y[0], error_;
    return H;
  }

 private:
  double error_;
};

TEST(CheckDesignMap, ConfirmsARightHessian) {
  const CurvedProducts map(0.0);
  const DesignMapCheck check = check_design_map(map, map.variables().start);
  EXPECT_TRUE(check.has_hessian);
  EXPECT_LT(check.hessian_gap, 1e-10);
  EXPECT_NEAR(check.hessian_slope, 2.0, 0.1);
}

TEST(CheckDesignMap, DetectsAWrongHessian) {
  const CurvedProducts map(1e-4);
  const DesignMapCheck check = check_design_map(map, map.variables().start);
  EXPECT_GT(check.hessian_gap, 1e-6);
  EXPECT_EQ(check.hessian_gap_name, "b and b");
  EXPECT_LT(check.gap, 1e-10);
  EXPECT_LT(check_design_map(CurvedProducts(5.0), map.variables().start).hessian_slope, 1.5);
}

TEST(CheckDesignMap, SaysThatAMapHasNoHessian) {
  const Products map(0.0);
  EXPECT_FALSE(check_design_map(map, map.variables().start).has_hessian);
  EXPECT_THROW(static_cast<void>(map.hessian(map.variables().start, Eigen::Vector2d::Ones())),
               InvalidInput);
}

TEST(CheckDesignMap, ConfirmsARightJacobian) {
  const Products map(0.0);
  const DesignMapCheck check = check_design_map(map, map.variables().start);
  EXPECT_LT(check.gap, 1e-10);
  EXPECT_NEAR(check.slope, 2.0, 0.1);
}

TEST(CheckDesignMap, DetectsAnErrorOfOnePartInAHundredThousand) {
  const Products map(1e-5);
  const DesignMapCheck check = check_design_map(map, map.variables().start);
  EXPECT_GT(check.gap, 1e-6);
  EXPECT_EQ(check.gap_name, "parameter 0 by b");
  EXPECT_LT(check_design_map(Products(0.1), map.variables().start).slope, 1.5);
}

TEST(CheckDesignMap, RefusesAWrongSize) {
  EXPECT_THROW(static_cast<void>(check_design_map(Products(0.0), Eigen::VectorXd::Ones(3))),
               InvalidInput);
}

}  // namespace
}  // namespace hbar
