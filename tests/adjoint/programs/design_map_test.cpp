#include "hbar/adjoint/programs/design_map.h"

#include <gtest/gtest.h>

#include <memory>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_model;

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

TEST(CheckDesignMap, ConvictsAWrongHessian) {
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

TEST(CheckDesignMap, ConvictsAnErrorOfOnePartInAHundredThousand) {
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

TEST(IdentityDesignMap, IsTheParametersWithTheirBounds) {
  const ParameterSet set = ParameterSet::all(small_model());
  const IdentityDesignMap map(set);
  EXPECT_EQ(map.variables().start, set.nominal());
  EXPECT_EQ(map.variables().lower, set.lower());
  EXPECT_EQ(map.variables().names[3], set[3].name);
  EXPECT_EQ(map.variables().units[3], set[3].unit);
  EXPECT_GT(map.variables().scale.minCoeff(), 0.0);
  EXPECT_EQ(map.parameters(set.nominal()), set.nominal());
  const DesignMapCheck check = check_design_map(map, set.nominal());
  EXPECT_LT(check.gap, 1e-9);
  EXPECT_TRUE(check.has_hessian);
  EXPECT_EQ(check.hessian_gap, 0.0);
}

TEST(InertiaChart, StartsAtTheNominalBodyAndIsRight) {
  const Model model = small_model();
  const ParameterSet set = ParameterSet::all(model);
  const InertiaChart chart(set);
  const Eigen::VectorXd start = chart.variables().start;
  EXPECT_LT((chart.parameters(start) - set.nominal()).norm(), 1e-12);
  const DesignMapCheck check = check_design_map(chart, start);
  EXPECT_LT(check.gap, 1e-9);
  EXPECT_GT(check.slope, 1.9);
  EXPECT_TRUE(check.has_hessian);
  EXPECT_EQ(check.hessian_gap, 0.0);
  const int ix = set.find("body.arm.inertia.x");
  EXPECT_EQ(chart.variables().names[static_cast<std::size_t>(ix)], "body.arm.second_moment.x");
}

TEST(InertiaChart, KeepsEveryPointWithinItsBoundsPhysical) {
  const Model model = small_model();
  const ParameterSet set = ParameterSet::named(model, {"body.arm.inertia", "body.hand.inertia"});
  const InertiaChart chart(set);
  Horizon horizon(model, set, {.integrator = "bdf1", .h = 0.01, .steps = 1});
  Inputs inputs = horizon.nominal_inputs();
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::VectorXd d = chart.variables().lower;
    for (int k = 0; k < 3; ++k) {
      if ((corner & (1 << k)) != 0) {
        d[k] *= 1e4;
      }
    }
    inputs.p = chart.parameters(d);
    EXPECT_NO_THROW(static_cast<void>(simulate(horizon, inputs))) << corner;
  }
  inputs.p = set.nominal();
  inputs.p[0] *= 10.0;  // without the chart: more than the sum of the other two
  EXPECT_THROW(static_cast<void>(simulate(horizon, inputs)), InvalidInput);
}

TEST(InertiaChart, RefusesHalfABodyAndAnImpossibleShare) {
  const Model model = small_model();
  EXPECT_THROW(InertiaChart(ParameterSet::named(model, {"body.arm.inertia.x"})), InvalidInput);
  EXPECT_THROW(InertiaChart(ParameterSet::all(model), 0.0), InvalidInput);
  EXPECT_THROW(InertiaChart(ParameterSet::all(model), 0.7), InvalidInput);
}

}  // namespace
}  // namespace hbar
