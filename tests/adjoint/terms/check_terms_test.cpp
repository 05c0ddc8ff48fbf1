#include "hbar/adjoint/terms/check_terms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

const ValuePlace kTorque{ValueField::kU, 2, 0};
const ValuePlace kRate{ValueField::kQdot, 3, 1};

/// u² q̇, with errors in a partial and in a second partial.
TermPointer faulty_term(double first_error, double second_error,
                        std::vector<SecondPlace> places = {{0, kTorque, kTorque},
                                                           {0, kRate, kTorque}}) {
  return user_term(
      "faulty", [](const TrajectoryValues& x) { return x.u(0, 2) * x.u(0, 2) * x.qdot(1, 3); },
      [=](const TrajectoryValues& x, TrajectoryPartials& partials) {
        partials.u(0, 2) += 2.0 * x.u(0, 2) * x.qdot(1, 3);
        partials.qdot(1, 3) += x.u(0, 2) * x.u(0, 2) * (1.0 + first_error);
      },
      {[=](const TrajectoryValues&) { return places; },
       [=](const TrajectoryValues& x, Eigen::Ref<Eigen::VectorXd> second) {
         for (std::size_t i = 0; i < places.size(); ++i) {
           const bool mixed = !(places[i].a == places[i].b);
           second[static_cast<Eigen::Index>(i)] =
               mixed ? 2.0 * x.u(0, 2) * (1.0 + second_error) : 2.0 * x.qdot(1, 3);
         }
       }});
}

/// Rows (0, u² q̇) with the same errors.
ConstraintPointer faulty_constraint(double first_error, double second_error) {
  const ConstraintRows rows{{"rest", "power"}, Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones()};
  return user_constraint(
      rows, {{1, ValueField::kU, 2, 0}, {1, ValueField::kQdot, 3, 1}},
      [](const TrajectoryValues& x, Eigen::Ref<Eigen::VectorXd> c) {
        c << 0.0, x.u(0, 2) * x.u(0, 2) * x.qdot(1, 3);
      },
      [=](const TrajectoryValues& x, Eigen::Ref<Eigen::VectorXd> partials) {
        partials << 2.0 * x.u(0, 2) * x.qdot(1, 3), x.u(0, 2) * x.u(0, 2) * (1.0 + first_error);
      },
      RowSecondPartials{{{1, kTorque, kTorque}, {1, kTorque, kRate}},
                        [=](const TrajectoryValues& x, Eigen::Ref<Eigen::VectorXd> second) {
                          second << 2.0 * x.qdot(1, 3), 2.0 * x.u(0, 2) * (1.0 + second_error);
                        }});
}

class CheckTerms : public ::testing::Test {
 protected:
  TrajectoryValues values_ = testing::random_values(9);
};

TEST_F(CheckTerms, ConfirmsWhatIsRight) {
  for (const TermCheck& check : {check_objective_term(*faulty_term(0.0, 0.0), values_),
                                 check_constraint_term(*faulty_constraint(0.0, 0.0), values_)}) {
    EXPECT_TRUE(check.passed());
    EXPECT_TRUE(check.has_second);
    EXPECT_LT(check.gap, 1e-10);
    EXPECT_LT(check.second_gap, 1e-10);
    EXPECT_NEAR(check.slope, 2.0, 0.1);
    EXPECT_NEAR(check.second_slope, 3.0, 0.1);
    EXPECT_EQ(check.idle, 0);
    EXPECT_EQ(check.repeated, 0);
  }
}

TEST_F(CheckTerms, DetectsAPartialThatIsWrong) {
  for (const TermCheck& check : {check_objective_term(*faulty_term(1e-4, 0.0), values_),
                                 check_constraint_term(*faulty_constraint(1e-4, 0.0), values_)}) {
    EXPECT_FALSE(check.passed());
    EXPECT_GT(check.gap, 1e-6);
    EXPECT_NE(check.gap_name.find(" by qdot 1 at step 3"), std::string::npos) << check.gap_name;
  }
  EXPECT_LT(check_objective_term(*faulty_term(0.5, 0.0), values_).slope, 1.5);
}

TEST_F(CheckTerms, DetectsASecondPartialThatIsWrong) {
  for (const TermCheck& check : {check_objective_term(*faulty_term(0.0, 1e-4), values_),
                                 check_constraint_term(*faulty_constraint(0.0, 1e-4), values_)}) {
    EXPECT_FALSE(check.passed());
    EXPECT_LT(check.gap, 1e-10);
    EXPECT_GT(check.second_gap, 1e-6);
    EXPECT_NE(check.second_gap_name.find(" by qdot 1 at step 3 and u 0 at step 2"),
              std::string::npos)
        << check.second_gap_name;
  }
  EXPECT_LT(check_constraint_term(*faulty_constraint(0.0, 0.5), values_).second_slope, 2.5);
}

TEST_F(CheckTerms, DetectsAPairThatIsMissingOrThereTwice) {
  const TermCheck missing =
      check_objective_term(*faulty_term(0.0, 0.0, {{0, kTorque, kTorque}}), values_);
  EXPECT_FALSE(missing.passed());
  EXPECT_GT(missing.second_gap, 0.1);
  const TermCheck twice = check_objective_term(
      *faulty_term(0.0, 0.0, {{0, kTorque, kTorque}, {0, kRate, kTorque}, {0, kTorque, kRate}}),
      values_);
  EXPECT_EQ(twice.repeated, 1);
  EXPECT_FALSE(twice.passed());
}

TEST_F(CheckTerms, DetectsNumbersThatAreNotWritten) {
  const ConstraintRows rows{{"row"}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
  const auto nothing = [](const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>) {};
  const auto zero = [](const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd> c) { c[0] = 0.0; };
  const std::vector<PartialPlace> places = {{0, ValueField::kP, 0, 1}};
  EXPECT_FALSE(
      check_constraint_term(*user_constraint(rows, places, zero, nothing), values_).passed());
  EXPECT_FALSE(
      check_constraint_term(*user_constraint(rows, places, nothing, zero), values_).passed());
}

TEST_F(CheckTerms, SaysWhatHasNoSecondPartialsAndCountsIdlePairs) {
  const TermPointer plain = user_term(
      "plain", [](const TrajectoryValues& x) { return x.p[0]; },
      [](const TrajectoryValues&, TrajectoryPartials& partials) { partials.p[0] += 1.0; });
  const TermCheck check = check_objective_term(*plain, values_);
  EXPECT_FALSE(check.has_second);
  EXPECT_TRUE(check.passed());
  values_.qdot(1, 3) = 0.0;
  EXPECT_EQ(check_objective_term(*faulty_term(0.0, 0.0), values_).idle, 1);
}

TEST_F(CheckTerms, RefusesPlacesThatAreNotThere) {
  EXPECT_THROW(static_cast<void>(check_objective_term(
                   *faulty_term(0.0, 0.0, {{0, {ValueField::kU, 7, 0}, kTorque}}), values_)),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(
                   check_objective_term(*faulty_term(0.0, 0.0, {{1, kRate, kTorque}}), values_)),
               InvalidInput);
}

/// Rates of three coordinates over two steps that differ in size.
TrajectoryValues rates(double scale) {
  TrajectoryValues values = testing::random_values(9);
  values.qdot.topLeftCorner(3, 3) << 0, 0.9, 0.5, 0, -0.4, 0.3, 0, 0.2, -0.8;
  values.qdot *= scale;
  return values;
}

std::vector<std::vector<ValuePlace>> rate_groups() {
  std::vector<std::vector<ValuePlace>> groups;
  for (int k = 1; k <= 2; ++k) {
    groups.push_back(
        {{ValueField::kQdot, k, 0}, {ValueField::kQdot, k, 1}, {ValueField::kQdot, k, 2}});
  }
  return groups;
}

/// A smooth largest magnitude: log Σ (exp βx + exp −βx) / β, saturated where βx is large.
TermPointer largest_rate(double beta) {
  return generic_sum("largest", rate_groups(), [beta](auto x) {
    using std::exp;
    using std::log;
    auto sum = exp(beta * x[0]) + exp(-beta * x[0]);
    for (std::size_t i = 1; i < x.size(); ++i) {
      sum = sum + exp(beta * x[i]) + exp(-beta * x[i]);
    }
    return log(sum) / beta;
  });
}

/// A term with a factor on its partials and second partials, right where both are 1.
TermPointer spoiled(TermPointer right, double first, double second) {
  return user_term(
      "spoiled", [right](const TrajectoryValues& x) { return right->value(x); },
      [right, first](const TrajectoryValues& x, TrajectoryPartials& partials) {
        TrajectoryPartials its(x);
        right->add_partials(x, its);
        partials.qdot += first * its.qdot;
      },
      {[right](const TrajectoryValues& x) { return right->second_places(x); },
       [right, second](const TrajectoryValues& x, Eigen::Ref<Eigen::VectorXd> out) {
         right->second_partials(x, out);
         out *= second;
       }});
}

TEST_F(CheckTerms, JudgesTermsNearSaturationRightly) {
  for (const double scale : {1.0, 5.0, 20.0}) {
    for (const double beta : {1.0, 4.0, 16.0}) {
      SCOPED_TRACE(concat("scale ", scale, ", beta ", beta));
      const TrajectoryValues values = rates(scale);
      const TermPointer right = largest_rate(beta);
      const TermCheck check = check_objective_term(*right, values);
      EXPECT_TRUE(check.passed()) << check.gap << ' ' << check.slope << ' ' << check.second_gap
                                  << ' ' << check.second_slope;
      EXPECT_TRUE(check_objective_term(*spoiled(right, 1.0, 1.0), values).passed());
      const TermCheck first = check_objective_term(*spoiled(right, 1.0 + 1e-5, 1.0), values);
      EXPECT_FALSE(first.passed());
      EXPECT_NEAR(first.gap, 1e-5, 1e-5);
      EXPECT_FALSE(check_objective_term(*spoiled(right, -1.0, 1.0), values).passed());
    }
  }
  // A second partial is judged where there is one worth the name.
  for (const double beta : {1.0, 4.0}) {
    EXPECT_FALSE(
        check_objective_term(*spoiled(largest_rate(beta), 1.0, 1.001), rates(1.0)).passed());
  }
}

TEST_F(CheckTerms, JudgesSteepTermsRightly) {
  const auto both = [](const char* name, const auto& f, const TrajectoryValues& values) {
    const TermPointer right = generic_sum(name, rate_groups(), f);
    const TermCheck check = check_objective_term(*right, values);
    EXPECT_TRUE(check.passed()) << name << ": " << check.gap << ' ' << check.slope << ' '
                                << check.second_gap << ' ' << check.second_slope;
    EXPECT_FALSE(check_objective_term(*spoiled(right, 1.0 + 1e-5, 1.0), values).passed()) << name;
    EXPECT_FALSE(check_objective_term(*spoiled(right, 1.0, 1.001), values).passed()) << name;
  };
  both(
      "tanh",
      [](auto x) {
        using std::exp;
        return x[1] * x[1] - 2.0 / (exp(80.0 * x[0]) + 1.0);  // a step of 2, as tanh 40 x
      },
      rates(1.0));
  both(
      "exponential",
      [](auto x) {
        using std::exp;
        return exp(60.0 * x[0] * x[0]);
      },
      rates(1.0));
  both(
      "barrier",
      [](auto x) {
        using std::log;
        return -log(x[0] * x[0] + 1e-4) - log(1.0001 - x[1] * x[1]);
      },
      rates(1.0));
  both(
      "root",
      [](auto x) {
        using std::sqrt;
        return sqrt(x[0] * x[0] + 1e-6) + sqrt(x[2] * x[2] + 1e-8);
      },
      rates(1.0));
}

}  // namespace
}  // namespace hbar
