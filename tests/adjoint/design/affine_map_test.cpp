#include "hbar/adjoint/design/affine_map.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/design/check_design_map.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::kInfinity;
using testing::message_of;
using testing::small_model;

DesignVariables two_lengths() {
  return design_variables({{.name = "a", .unit = "m", .start = 1.0},
                           {.name = "b", .unit = "m", .start = 2.0, .lower = 1.0, .upper = 5.0}});
}

TEST(AffineMap, IsBasePlusSlopesTimesVariables) {
  Eigen::MatrixXd slopes(3, 2);
  slopes << 1.0, 0.0, -0.5, 2.0, 0.0, 0.0;
  const DesignMapPointer map = affine_map(two_lengths(), Eigen::Vector3d(10.0, 20.0, 30.0), slopes);
  EXPECT_EQ(map->parameter_count(), 3);
  EXPECT_EQ(map->parameters(Eigen::Vector2d(3.0, 4.0)), Eigen::Vector3d(13.0, 26.5, 30.0));
  EXPECT_EQ(map->jacobian(Eigen::Vector2d(3.0, 4.0)), slopes);
  EXPECT_TRUE(map->hessian(Eigen::Vector2d(3.0, 4.0), Eigen::Vector3d::Ones()).isZero(0.0));
  EXPECT_TRUE(map->depends(1, 1));
  EXPECT_FALSE(map->depends(0, 1));
  EXPECT_FALSE(map->depends(2, 0));
}

TEST(AffineMap, RefusesSizesThatDoNotFitAndNumbersThatAreNone) {
  const auto refusal = [](const Eigen::VectorXd& base, const Eigen::MatrixXd& slopes) {
    return message_of<InvalidInput>(
        [&] { static_cast<void>(affine_map(two_lengths(), base, slopes)); });
  };
  EXPECT_EQ(refusal(Eigen::VectorXd::Ones(3), Eigen::MatrixXd::Ones(2, 3)),
            "affine_map: slopes are 2 x 3; they must be 3 x 2");
  EXPECT_EQ(refusal(Eigen::VectorXd::Constant(3, kInfinity), Eigen::MatrixXd::Ones(3, 2)),
            "affine_map: base and slopes must be finite");
}

TEST(ParameterMap, IsTheParametersWithTheirBounds) {
  const ParameterSet set = ParameterSet::all(small_model());
  const DesignMapPointer pointer = parameter_map(set);
  const DesignMap& map = *pointer;
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

TEST(ParameterMap, NarrowsTheBoundsOfParametersThatAreNamed) {
  const ParameterSet set = ParameterSet::all(small_model());
  const int i = set.find("body.arm.mass");
  const double mass = set[i].nominal;
  const DesignMapPointer map =
      parameter_map(set, {{.name = "body.arm.mass", .lower = 0.5 * mass, .upper = 1.5 * mass}});
  EXPECT_EQ(map->variables().lower[i], 0.5 * mass);
  EXPECT_EQ(map->variables().upper[i], 1.5 * mass);
  EXPECT_DOUBLE_EQ(map->variables().scale[i], 0.25 * mass);
  EXPECT_EQ(map->variables().lower[i + 1], set.lower()[i + 1]);
  // The set's own bounds still hold: a mass is positive.
  EXPECT_EQ(parameter_map(set, {{.name = "body.arm.mass", .lower = 0.0}})->variables().lower[i],
            set.lower()[i]);
}

TEST(ParameterMap, RefusesANameThatIsNotThereAndBoundsWithoutTheNominalValue) {
  const ParameterSet set = ParameterSet::all(small_model());
  const auto refusal = [&](const ParameterBounds& bounds) {
    return message_of<InvalidInput>([&] { static_cast<void>(parameter_map(set, {bounds})); });
  };
  EXPECT_NE(refusal({.name = "body.arm.mas"}).find("body.arm.mas"), std::string::npos);
  EXPECT_NE(refusal({.name = "body.arm.mass", .lower = 1e3})
                .find("which is not within its bounds, 1000 to inf"),
            std::string::npos);
  EXPECT_EQ(refusal({.name = "body.arm.mass", .lower = -3.0}),
            "parameter_map: the lower bound of body.arm.mass is -3; it must be ≥ 0");
}

TEST(InertiaChart, StartsAtTheNominalBodyAndIsRight) {
  const Model model = small_model();
  const ParameterSet set = ParameterSet::all(model);
  const DesignMapPointer pointer = inertia_chart(set);
  const DesignMap& chart = *pointer;
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
  const DesignMapPointer pointer = inertia_chart(set);
  const DesignMap& chart = *pointer;
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
  EXPECT_THROW(static_cast<void>(inertia_chart(ParameterSet::named(model, {"body.arm.inertia.x"}))),
               InvalidInput);
  for (const double share : {0.0, 0.7}) {
    EXPECT_THROW(static_cast<void>(inertia_chart(ParameterSet::all(model), share)), InvalidInput);
  }
}

}  // namespace
}  // namespace hbar
