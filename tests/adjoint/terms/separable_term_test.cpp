#include "hbar/adjoint/terms/separable_term.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

Jet cosh_jet(double x) { return {std::cosh(x), std::sinh(x), std::cosh(x)}; }

TEST(SeparableTerm, TakesAnyFunctionOfOneNumber) {
  const TrajectoryValues values = testing::random_values(1);
  const TermPointer term = separable_term(
      "cosh",
      {{.field = ValueField::kMeasured, .rows = {4, 1}, .weight = 0.3, .times_h = true},
       {.field = ValueField::kU, .target = Eigen::Vector2d(0.5, -0.5), .final_only = true}},
      cosh_jet);
  double expected = 0.0;
  for (int k = 1; k <= 5; ++k) {
    expected += 0.3 * 0.1 * (std::cosh(values.v()(4, k)) + std::cosh(values.v()(1, k)));
  }
  expected += std::cosh(values.u(0, 4) - 0.5) + std::cosh(values.u(1, 4) + 0.5);
  EXPECT_NEAR(term->value(values), expected, 1e-14);
  EXPECT_EQ(term->second_places(values).size(), 12U);
  const TermCheck check = check_objective_term(*term, values);
  EXPECT_TRUE(check.passed()) << check.gap_name << ' ' << check.second_gap_name;
  EXPECT_NEAR(check.second_slope, 3.0, 0.1);
  EXPECT_EQ(check.idle, 0);
}

TEST(SeparableTerm, HasNoSecondPlacesWhereNothingCounts) {
  const TrajectoryValues values = testing::random_values(2);
  const StepWeights last{(Eigen::VectorXd(5) << 0.0, 0.0, 0.0, 0.0, 2.0).finished()};
  const TermPointer term = separable_term("end", {{.steps = last}}, cosh_jet);
  EXPECT_EQ(term->second_places(values).size(), 4U);
  EXPECT_TRUE(separable_term("none", {{.weight = 0.0}}, cosh_jet)->second_places(values).empty());
  EXPECT_TRUE(separable_term("linear", {{}}, cosh_jet, true)->second_places(values).empty());
}

TEST(StepWeights, AreOneUnlessTheySayOtherwise) {
  EXPECT_EQ(StepWeights().of(3), 1.0);
  const StepWeights weights = StepWeights::over_time(4, 0.5, [](double t) { return t * t; });
  EXPECT_EQ(weights.each, Eigen::Vector4d(0.25, 1.0, 2.25, 4.0));
  EXPECT_EQ(weights.of(2), 1.0);
  EXPECT_THROW(static_cast<void>(StepWeights::over_time(0, 0.5, [](double t) { return t; })),
               InvalidInput);
}

TEST(SeparableTerm, RefusesWhatDoesNotFit) {
  const TrajectoryValues values = testing::random_values(3);
  const auto make = [](const StepSum& sum) { return separable_term("mine", {sum}, cosh_jet); };
  const TermPointer four = make({.steps = {Eigen::VectorXd::Ones(4)}});
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(four->value(values)); }),
            "mine: there are 4 weights of steps; there must be 5 or none");
  EXPECT_EQ(testing::message_of<InvalidInput>(
                [&] { static_cast<void>(make({.steps = {Eigen::Vector2d(1.0, -1.0)}})); }),
            "mine: the weight of step 2 is -1; it must be ≥ 0");
  EXPECT_THROW(static_cast<void>(make({.field = ValueField::kP})), InvalidInput);
  EXPECT_THROW(static_cast<void>(make({.weight = testing::kNan})), InvalidInput);
  EXPECT_THROW(static_cast<void>(make({.rows = {1, 1}})), InvalidInput);
}

}  // namespace
}  // namespace hbar
