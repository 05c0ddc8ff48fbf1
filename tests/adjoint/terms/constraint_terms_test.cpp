#include "hbar/adjoint/terms/constraint_terms.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::kInfinity;
using testing::message_of;

constexpr int kConstrainedSteps = 5;

class ConstraintTerms : public ::testing::Test {
 protected:
  ConstraintTerms() {
    testing::Random random(3);
    values_.h = 0.1;
    values_.q = random.matrix(model_.dof(), kConstrainedSteps + 1);
    values_.qdot = random.matrix(model_.dof(), kConstrainedSteps + 1);
    values_.measured_rows = {model_.variable_count(), 0};
    values_.measured = random.matrix(model_.variable_count() + 2, kConstrainedSteps + 1);
    values_.u = random.matrix(model_.control_count(), kConstrainedSteps);
    values_.p = set_.nominal();
  }

  /// The rows' values, after a check of the partials.
  [[nodiscard]] Eigen::VectorXd checked(const ConstraintPointer& term) const {
    const TermCheck check = check_constraint_term(*term, values_);
    EXPECT_TRUE(check.passed() && check.has_second) << check.gap_name;
    EXPECT_TRUE(term->second_places().empty());
    Eigen::VectorXd partials(static_cast<Eigen::Index>(term->places().size()));
    term->partials(values_, partials);
    EXPECT_GT(partials.cwiseAbs().minCoeff(), 0.0);
    Eigen::VectorXd c(term->rows().size());
    term->values(values_, c);
    return c;
  }

  Model model_ = testing::small_model();
  ParameterSet set_ = ParameterSet::named(
      model_,
      {"body.arm.mass", "body.hand.mass", "joint.hinge.stiffness", "joint.slider.stiffness"});
  TrajectoryValues values_;
};

TEST_F(ConstraintTerms, OnAnyNumberHaveARowPerStep) {
  const ConstraintPointer term =
      value_limits("grip", ValueField::kMeasured, 1, {2, 5}, 1.5, kInfinity);
  EXPECT_EQ(term->rows().names[1], "grip at step 5");
  EXPECT_EQ(term->rows().lower, Eigen::Vector2d(1.5, 1.5));
  EXPECT_EQ(term->rows().upper, Eigen::Vector2d(kInfinity, kInfinity));
  EXPECT_EQ(checked(term), Eigen::Vector2d(values_.measured(1, 2), values_.measured(1, 5)));
  const ConstraintPointer on_p = value_limits("arm", ValueField::kP, 1, {1, 2, 3}, 0.0, 1.0);
  EXPECT_EQ(on_p->rows().names, std::vector<std::string>{"arm"});
  EXPECT_EQ(checked(on_p)[0], values_.p[1]);
  EXPECT_EQ(value_limits("free", ValueField::kQ, 0, {1}, -kInfinity, kInfinity)->rows().size(), 0);
}

TEST_F(ConstraintTerms, OnRatesNameTheCoordinate) {
  const ConstraintPointer term = rate_limits(model_, 6, {3}, -2.0, 2.0);
  EXPECT_EQ(term->rows().names[0], "hinge rate at step 3");
  EXPECT_EQ(checked(term)[0], values_.qdot(6, 3));
}

TEST_F(ConstraintTerms, OnAPathAreABoxWithoutItsOpenSides) {
  const ConstraintPointer term = variable_limits(model_, "corner", {1, 4}, {-1.0, -kInfinity, 0.0},
                                                 {1.0, kInfinity, kInfinity});
  ASSERT_EQ(term->rows().size(), 4);
  EXPECT_EQ(term->rows().names[3], "corner.z at step 4");
  EXPECT_EQ(checked(term), Eigen::Vector4d(values_.v()(3, 1), values_.v()(5, 1), values_.v()(3, 4),
                                           values_.v()(5, 4)));
}

TEST_F(ConstraintTerms, OnChangesOfControlsReadTwoStepsEach) {
  const Eigen::Index controls = model_.control_count();
  Eigen::VectorXd change = Eigen::VectorXd::Constant(controls, 0.5);
  change[1] = kInfinity;
  const ConstraintPointer term = control_rate(model_, kConstrainedSteps, change);
  ASSERT_EQ(term->rows().size(), 4 * (controls - 1));
  EXPECT_EQ(term->rows().names[0], "hinge change at step 1");
  EXPECT_EQ(term->rows().lower, -term->rows().upper);
  EXPECT_DOUBLE_EQ(checked(term)[0], values_.u(0, 1) - values_.u(0, 0));
  const ConstraintPointer alike = control_rate(model_, 3, Eigen::VectorXd::Constant(1, 0.5));
  EXPECT_EQ(alike->rows().size(), 2 * controls);
}

TEST_F(ConstraintTerms, OfAPeriodCompareItsEndWithItsStart) {
  const ConstraintPointer term =
      periodicity(model_, kConstrainedSteps, {0, 6}, Eigen::Vector2d(0.7, 0.0));
  EXPECT_EQ(term->rows().names[1], "hinge period");
  EXPECT_EQ(term->rows().names[3], "hinge rate period");
  EXPECT_EQ(term->rows().lower, Eigen::Vector4d(0.7, 0.0, 0.0, 0.0));
  EXPECT_EQ(term->rows().upper, term->rows().lower);
  const Eigen::VectorXd c = checked(term);
  EXPECT_DOUBLE_EQ(c[0], values_.q(0, 5) - values_.q(0, 0));
  EXPECT_DOUBLE_EQ(c[3], values_.qdot(6, 5) - values_.qdot(6, 0));
  EXPECT_EQ(periodicity(model_, kConstrainedSteps)->rows().size(), 2 * model_.dof());
}

TEST_F(ConstraintTerms, TieParameters) {
  const ConstraintPointer term =
      parameter_tie(set_, "joint.hinge.stiffness", 2.0, "joint.slider.stiffness", -3.0);
  EXPECT_EQ(term->rows().names[0], "joint.hinge.stiffness tied to joint.slider.stiffness");
  EXPECT_EQ(term->rows().lower[0], -3.0);
  EXPECT_DOUBLE_EQ(checked(term)[0], 0.7 - 2.0 * 30.0);
}

TEST_F(ConstraintTerms, OnTheTotalMassCountFixedBodiesToo) {
  double mass = 0.0;
  for (const Link& link : model_.links()) {
    mass += link.body.mass;
  }
  const ConstraintPointer term = total_mass(set_, model_, 0.0, 20.0);
  EXPECT_EQ(term->places().size(), 2U);
  EXPECT_NEAR(checked(term)[0], mass, 1e-12 * mass);
  values_.p[set_.find("body.arm.mass")] += 1.0;
  EXPECT_NEAR(checked(term)[0], mass + 1.0, 1e-12 * mass);
}

TEST_F(ConstraintTerms, RefuseWhatMakesNoSense) {
  EXPECT_EQ(step_range(2, 7, 2), (std::vector<int>{2, 4, 6}));
  EXPECT_THROW(static_cast<void>(step_range(3, 2)), InvalidInput);
  EXPECT_THROW(static_cast<void>(step_range(1, 2, 0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(value_limits("a", ValueField::kQ, 0, {-1}, 0.0, 1.0)),
               InvalidInput);
  EXPECT_EQ(message_of<InvalidInput>(
                [] { static_cast<void>(value_limits("a", ValueField::kQ, 0, {1}, 2.0, 1.0)); }),
            "constraint 'a at step 1': the lower bound 2 must not exceed the upper one, 1");
  EXPECT_THROW(static_cast<void>(rate_limits(model_, 99, {1}, 0.0, 1.0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(variable_limits(model_, "corn", {1}, Eigen::Vector3d::Zero(),
                                                 Eigen::Vector3d::Ones())),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(control_rate(model_, 5, Eigen::Vector2d::Ones())), InvalidInput);
  EXPECT_THROW(static_cast<void>(control_rate(model_, 5, Eigen::VectorXd::Constant(1, -1.0))),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(periodicity(model_, 0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(periodicity(model_, 5, {99})), InvalidInput);
  EXPECT_THROW(static_cast<void>(periodicity(model_, 5, {0}, Eigen::Vector2d::Zero())),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(parameter_tie(set_, "body.arm.mass", 1.0, "body.arm.mass")),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(parameter_tie(set_, "body.arm.mass", 1.0, "body.leg.mass")),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(total_mass(ParameterSet(), model_, 0.0, 1.0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(total_mass(ParameterSet::all(model_), model_, 0.0, 1.0)),
               InvalidInput);
}

}  // namespace
}  // namespace hbar
