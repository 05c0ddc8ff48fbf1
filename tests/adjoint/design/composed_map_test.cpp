#include "hbar/adjoint/design/composed_map.h"

#include <gtest/gtest.h>

#include <array>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/design/check_design_map.h"
#include "hbar/adjoint/design/formula_map.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

DesignVariables variables(const std::string& names, double start) {
  std::vector<DesignVariable> out;
  for (const char name : names) {
    out.push_back({.name = std::string(1, name), .start = start});
  }
  return design_variables(out);
}

template <typename Scalar>
auto sizes(const std::span<const Scalar>& d) {
  return std::array{d[0] * d[0], d[0] * d[1]};
}
template <typename Numbers>
auto masses(const Numbers& s) {
  return std::array{s[0] * s[1], sin(s[1]), s[0]};
}

TEST(ComposedMap, IsTheSameAsOneFormulaForBoth) {
  const DesignMapPointer composed =
      compose(formula_map(variables("st", 1.0), [](auto s) { return masses(s); }),
              formula_map(variables("abc", 0.7), [](auto d) { return sizes(d); }));
  const DesignMapPointer at_once =
      formula_map(variables("abc", 0.7), [](auto d) { return masses(sizes(d)); });
  const Eigen::Vector3d d(0.9, -0.4, 2.0);
  const Eigen::Vector3d y(1.3, -0.2, 0.8);
  EXPECT_EQ(composed->variables().names, at_once->variables().names);
  EXPECT_EQ(composed->parameter_count(), 3);
  EXPECT_LT((composed->parameters(d) - at_once->parameters(d)).norm(), 1e-15);
  EXPECT_LT((composed->jacobian(d) - at_once->jacobian(d)).norm(), 1e-15);
  EXPECT_LT((composed->hessian(d, y) - at_once->hessian(d, y)).norm(), 1e-14);
  for (int p = 0; p < 3; ++p) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(composed->depends(p, i), at_once->depends(p, i)) << p << " by " << i;
    }
  }
  EXPECT_LT(check_design_map(*composed, d).hessian_gap, 1e-9);
}

TEST(ComposedMap, RefusesMapsThatDoNotFit) {
  const DesignMapPointer two =
      affine_map(variables("ab", 1.0), Eigen::Vector3d::Zero(), Eigen::MatrixXd::Ones(3, 2));
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(compose(two, two)); }),
            "compose: the outer map has 2 variables; the inner one gives 3");
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(compose(two, nullptr)); }),
            "compose: a map is null");
}

}  // namespace
}  // namespace hbar
