#include "hbar/adjoint/design/formula_map.h"

#include <gtest/gtest.h>

#include <array>

#include "hbar/adjoint/design/check_design_map.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::message_of;
using testing::small_model;

/// Length and width of a cuboid, and a number that decides nothing but the last parameter.
DesignVariables cuboid() {
  return design_variables({{.name = "length", .unit = "m", .start = 0.8},
                           {.name = "width", .unit = "m", .start = 0.3},
                           {.name = "shift", .unit = "m", .start = 0.1}});
}

/// m = ρ l w², I_x = ρ l w⁴ / 6, I_y = ρ (l³ w² + l w⁴) / 12, and sin(shift).
DesignMapPointer cuboid_map() {
  return formula_map(cuboid(), [](auto d) {
    const auto l = d[0];
    const auto w = d[1];
    const auto m = 700.0 * l * w * w;
    return std::array{m, m * w * w / 6.0, m * (l * l + w * w) / 12.0, sin(d[2])};
  });
}

TEST(FormulaMap, HasTheJacobianAndHessianThatADerivationByHandGives) {
  const DesignMapPointer map = cuboid_map();
  const double l = 0.7, w = 0.35, s = -0.4, rho = 700.0;
  const Eigen::Vector3d d(l, w, s);
  const double w2 = w * w, w3 = w2 * w, w4 = w3 * w, l2 = l * l, l3 = l2 * l;
  EXPECT_LT((map->parameters(d) - Eigen::Vector4d(rho * l * w2, rho * l * w4 / 6.0,
                                                  rho * (l3 * w2 + l * w4) / 12.0, std::sin(s)))
                .norm(),
            1e-13);
  Eigen::MatrixXd J(4, 3);
  J << rho * w2, 2.0 * rho * l * w, 0.0,                                                   //
      rho * w4 / 6.0, rho * l * w3 / 1.5, 0.0,                                             //
      rho * w2 * (3.0 * l2 + w2) / 12.0, rho * l * w * (2.0 * l2 + 4.0 * w2) / 12.0, 0.0,  //
      0.0, 0.0, std::cos(s);
  EXPECT_LT((map->jacobian(d) - J).norm(), 1e-13 * J.norm());
  const Eigen::Vector4d y(1.1, -0.7, 2.3, 0.9);
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  H(0, 0) = y[2] * rho * l * w2 / 2.0;
  H(0, 1) = H(1, 0) =
      rho * (y[0] * 2.0 * w + y[1] * w3 / 1.5 + y[2] * (6.0 * l2 * w + 4.0 * w3) / 12.0);
  H(1, 1) = rho * (y[0] * 2.0 * l + y[1] * 2.0 * l * w2 + y[2] * (2.0 * l3 + 12.0 * l * w2) / 12.0);
  H(2, 2) = -y[3] * std::sin(s);
  EXPECT_LT((map->hessian(d, y) - H).norm(), 1e-13 * H.norm());
}

TEST(FormulaMap, PassesTheCheckOfDesignMaps) {
  const DesignMapPointer map = cuboid_map();
  const DesignMapCheck check = check_design_map(*map, map->variables().start);
  EXPECT_LT(check.gap, 1e-9);
  EXPECT_NEAR(check.slope, 2.0, 0.1);
  EXPECT_TRUE(check.has_hessian);
  EXPECT_LT(check.hessian_gap, 1e-9);
  EXPECT_NEAR(check.hessian_slope, 2.0, 0.1);
}

TEST(FormulaMap, KnowsWhatDependsOnWhatEvenWhereTheSlopeVanishes) {
  const DesignMapPointer map = formula_map(cuboid(), [](auto d) {
    const auto zero = d[0] - 0.8;  // at the start
    return std::array{zero * d[1], zero * zero, 1.0 + 0.0 * d[2]};
  });
  EXPECT_TRUE(map->depends(0, 0));
  EXPECT_TRUE(map->depends(0, 1));
  EXPECT_TRUE(map->depends(1, 0));
  EXPECT_FALSE(map->depends(1, 1));
  EXPECT_FALSE(map->depends(2, 0));
}

TEST(FormulaMap, SetsParametersByNameAndLeavesTheOthers) {
  const ParameterSet set = ParameterSet::named(small_model(), {"body.arm.mass", "body.hand.mass"});
  const DesignMapPointer map = formula_map(set, cuboid(), [](auto d, auto& p) {
    p["body.hand.mass"] = 5.0 * d[0];
    p["body.hand.mass"] += d[1];
  });
  const Eigen::VectorXd p = map->parameters(Eigen::Vector3d(2.0, 0.25, 9.0));
  EXPECT_EQ(p[set.find("body.arm.mass")], set.nominal()[set.find("body.arm.mass")]);
  EXPECT_EQ(p[set.find("body.hand.mass")], 10.25);
  EXPECT_FALSE(map->depends(set.find("body.arm.mass"), 0));
}

TEST(FormulaMap, NamesTheNearestParameterWhereOneIsMissing) {
  const ParameterSet set = ParameterSet::named(small_model(), {"body.arm.mass"});
  EXPECT_EQ(message_of<InvalidInput>([&] {
              static_cast<void>(
                  formula_map(set, cuboid(), [](auto d, auto& p) { p["body.arm.mas"] = d[0]; }));
            }),
            "formula_map: parameter 'body.arm.mas' is not in the set; did you mean "
            "'body.arm.mass'?");
}

TEST(FormulaMap, RefusesWhatIsNotFiniteAtTheStartAndAnotherSizeLater) {
  EXPECT_EQ(message_of<InvalidInput>([] {
              static_cast<void>(
                  formula_map(cuboid(), [](auto d) { return std::array{sqrt(d[0] - 0.8)}; }));
            }),
            "formula_map: the formula or its derivative is not finite at the start");
  const DesignMapPointer grows = formula_map(
      cuboid(), [](auto d) { return std::vector<HyperDual>(d[0].value > 1.0 ? 2 : 1, d[0]); });
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { static_cast<void>(grows->parameters(Eigen::Vector3d(2.0, 0.0, 0.0))); }),
            "formula_map: the formula gives 2 parameters here; at the start it gave 1");
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { static_cast<void>(grows->parameters(Eigen::Vector2d::Ones())); }),
            "formula_map: d has 2 entries; the map has 3 variables");
}

TEST(FormulaMap, SaysSoWhereABranchBringsInAnotherVariable) {
  const DesignMapPointer map =
      formula_map(cuboid(), [](auto d) { return std::array{d[0].value > 1.0 ? d[1] : d[0]}; });
  EXPECT_FALSE(map->depends(0, 1));
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { static_cast<void>(map->jacobian(Eigen::Vector3d(2.0, 0.3, 0.1))); }),
            "formula_map: parameter 0 depends on 'width' here, but not at the start; avoid the "
            "branch");
}

}  // namespace
}  // namespace hbar
