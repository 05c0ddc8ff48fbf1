#include "hbar/adjoint/terms/check_terms.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hbar
