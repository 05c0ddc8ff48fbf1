#include "hbar/adjoint/terms/generic_terms.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

using testing::message_of;

constexpr ValuePlace kPower[] = {{ValueField::kU, 2, 0}, {ValueField::kQdot, 3, 1}};

/// A formula that needs every kind of function, positive for all numbers in [−1, 1].
const auto kWild = [](auto x) {
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  return sqrt(x[0] * x[0] + 0.5) * exp(x[1]) + log(x[2] * x[2] + 1.5) / (sin(x[0] * x[1]) + 2.0);
};

TEST(GenericTerm, IsExactToItsSecondPartials) {
  const TrajectoryValues values = testing::random_values(1);
  const TermPointer term = generic_term(
      "wild", {{ValueField::kQ, 5, 1}, {ValueField::kMeasured, 2, 2}, {ValueField::kP, 0, 0}},
      kWild);
  const TermCheck check = check_objective_term(*term, values);
  EXPECT_TRUE(check.has_second);
  EXPECT_TRUE(check.passed()) << check.gap_name << ' ' << check.second_gap_name;
  EXPECT_LT(check.gap, 1e-10);
  EXPECT_LT(check.second_gap, 1e-10);
  EXPECT_NEAR(check.slope, 2.0, 0.1);
  EXPECT_NEAR(check.second_slope, 3.0, 0.1);
}

TEST(GenericTerm, EqualsTheTermThatIsWrittenByHand) {
  const TrajectoryValues values = testing::random_values(2);
  std::vector<std::vector<ValuePlace>> changes;
  for (int k = 1; k < 5; ++k) {
    for (int i = 0; i < 2; ++i) {
      changes.push_back({{ValueField::kU, k, i}, {ValueField::kU, k - 1, i}});
    }
  }
  const TermPointer generic = generic_sum(
      "changes", changes, [](auto x) { return 0.5 * (x[0] - x[1]) * (x[0] - x[1]) / 0.1; });
  const TermPointer by_hand = control_smoothness();
  EXPECT_NEAR(generic->value(values), by_hand->value(values), 1e-13);
  const Eigen::VectorXd expected = testing::flatten_values(Objective(by_hand).partials(values));
  EXPECT_LT(
      testing::relative_gap(testing::flatten_values(Objective(generic).partials(values)), expected),
      1e-14);
  // The pairs that groups share are listed once.
  EXPECT_EQ(generic->second_places(values).size(), by_hand->second_places(values).size());
  EXPECT_TRUE(check_objective_term(*generic, values).passed());
}

TEST(GenericSum, WeighsItsGroups) {
  const TrajectoryValues values = testing::random_values(3);
  const auto square = [](auto x) { return x[0] * x[0]; };
  const TermPointer term =
      generic_sum("squares", {{kPower[0]}, {kPower[1]}}, square, Eigen::Vector2d(2.0, -3.0));
  EXPECT_DOUBLE_EQ(term->value(values),
                   2.0 * std::pow(values.u(0, 2), 2) - 3.0 * std::pow(values.qdot(1, 3), 2));
  EXPECT_TRUE(check_objective_term(*term, values).passed());
}

TEST(GenericConstraint, IsExactToItsSecondPartials) {
  const TrajectoryValues values = testing::random_values(4);
  const std::vector<ValuePlace> power(std::begin(kPower), std::end(kPower));
  const ConstraintPointer term = generic_constraint(
      {{"power", -1.0, 1.0, power, [](auto x) { return x[0] * x[1]; }},
       {"wild",
        0.0,
        2.0,
        {{ValueField::kQ, 5, 1}, {ValueField::kU, 2, 0}, {ValueField::kMeasured, 1, 7}},
        kWild}});
  EXPECT_EQ(term->rows().names[1], "wild");
  EXPECT_EQ(term->rows().upper, Eigen::Vector2d(1.0, 2.0));
  Eigen::VectorXd c(2);
  term->values(values, c);
  EXPECT_DOUBLE_EQ(c[0], values.u(0, 2) * values.qdot(1, 3));
  const TermCheck check = check_constraint_term(*term, values);
  EXPECT_TRUE(check.passed()) << check.gap_name << ' ' << check.second_gap_name;
  EXPECT_LT(check.second_gap, 1e-10);
  EXPECT_EQ(check.idle, 2);  // ∂²(u q̇)/∂u² and ∂²(u q̇)/∂q̇²: a formula does not tell
}

TEST(GenericConstraint, MayHaveOneFormulaForAllRows) {
  const TrajectoryValues values = testing::random_values(5);
  const ConstraintRows rows{{"a", "b"}, Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones()};
  const ConstraintPointer term =
      generic_constraint(rows, {{kPower[0]}, {kPower[1]}}, [](auto x) { return x[0] * x[0]; });
  Eigen::VectorXd c(2);
  term->values(values, c);
  EXPECT_DOUBLE_EQ(c[1], std::pow(values.qdot(1, 3), 2));
  EXPECT_TRUE(check_constraint_term(*term, values).passed());
}

TEST(GenericTerms, RefuseWhatDoesNotFit) {
  const auto square = [](auto x) { return x[0] * x[0]; };
  EXPECT_EQ(message_of<InvalidInput>([&] {
              static_cast<void>(generic_term("a", {kPower[0], kPower[0]}, square));
            }),
            "'a': u 0 at step 2 is named twice");
  EXPECT_THROW(static_cast<void>(generic_sum("a", {{kPower[0]}}, square, Eigen::Vector2d::Ones())),
               InvalidInput);
  EXPECT_THROW(
      static_cast<void>(generic_constraint({{"row", 0.0, 1.0, {kPower[1], kPower[1]}, square}})),
      InvalidInput);
  const ConstraintRows rows{{"a"}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};
  EXPECT_THROW(static_cast<void>(generic_constraint(rows, {}, square)), InvalidInput);
  const TermPointer far = generic_term("far", {{ValueField::kU, 5, 0}}, square);
  EXPECT_THROW(static_cast<void>(far->value(testing::random_values(1))), InvalidInput);
}

}  // namespace
}  // namespace hbar
