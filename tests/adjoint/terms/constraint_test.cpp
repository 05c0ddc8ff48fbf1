#include "hbar/adjoint/terms/constraint.h"

#include <gtest/gtest.h>

#include <limits>

#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using Field = PartialPlace::Field;
using testing::kInfinity;
using testing::small_model;

TrajectoryValues numbered(const Model& model, const ParameterSet& set, int steps) {
  TrajectoryValues out;
  out.h = 0.1;
  const auto fill = [](Eigen::Index rows, Eigen::Index columns, double first) {
    return Eigen::MatrixXd(
        Eigen::VectorXd::LinSpaced(rows * columns, first, first + 1.0).reshaped(rows, columns));
  };
  out.q = fill(model.dof(), steps + 1, 1.0);
  out.qdot = fill(model.dof(), steps + 1, 2.0);
  out.u = fill(model.control_count(), steps, 4.0);
  out.p = set.nominal();
  out.measured_rows = {model.variable_count(), 1};
  out.measured.resize(model.variable_count() + 3, steps + 1);
  out.v() = fill(model.variable_count(), steps + 1, 3.0);
  out.tactile().setConstant(4.0);
  out.declared() = fill(2, steps + 1, 5.0);
  return out;
}

void expect_right_partials(const ConstraintTerm& term, const TrajectoryValues& at) {
  const TermCheck check = check_constraint_term(term, at);
  EXPECT_LT(check.gap, 1e-10) << check.gap_name;
  EXPECT_TRUE(check.has_second);
  EXPECT_TRUE(check.passed()) << check.second_gap_name << ' ' << check.slope;
}

class Constraint : public ::testing::Test {
 protected:
  Model model_ = small_model();
  ParameterSet set_ = ParameterSet::all(model_);
  TrajectoryValues values_ = numbered(model_, set_, 5);
};

TEST_F(Constraint, OnAnEndEffectorIsABoxAroundTheTarget) {
  const ConstraintPointer term = variable_at_step(model_, "corner", 3, {1.0, 2.0, 3.0}, 0.25);
  EXPECT_EQ(term->rows().names[1], "corner.y at step 3");
  EXPECT_EQ(term->rows().lower, Eigen::Vector3d(0.75, 1.75, 2.75));
  EXPECT_EQ(term->rows().upper, Eigen::Vector3d(1.25, 2.25, 3.25));
  Eigen::VectorXd c(3);
  term->values(values_, c);
  EXPECT_EQ(c, values_.v().col(3).segment(3, 3));
  expect_right_partials(*term, values_);
  const ConstraintPointer equation = variable_at_step(model_, "tip", 1, {1.0, 2.0, 3.0});
  EXPECT_EQ(equation->rows().lower, equation->rows().upper);
}

TEST_F(Constraint, OnACoordinateHasARowPerStep) {
  const ConstraintPointer term = coordinate_limits(model_, 2, {1, 4}, -1.0, 2.0);
  ASSERT_EQ(term->rows().size(), 2);
  Eigen::VectorXd c(2);
  term->values(values_, c);
  EXPECT_EQ(c, Eigen::Vector2d(values_.q(2, 1), values_.q(2, 4)));
  EXPECT_EQ(term->rows().lower, Eigen::Vector2d(-1.0, -1.0));
  expect_right_partials(*term, values_);
}

TEST_F(Constraint, OnJointsTakesTheModelsLimits) {
  EXPECT_EQ(joint_limits(model_, {1, 2})->rows().size(), 0);
  ModelBuilder builder("limited");
  Joint hinge{.name = "hinge", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}};
  hinge.limits = JointLimits{.lower = -1.0, .upper = 2.0};
  builder.add_link(-1, hinge, solid_body("rod", Cuboid{{1.0, 0.1, 0.1}}, 10.0));
  const ConstraintPointer term = joint_limits(builder.build(), {1, 2}, 0.1);
  EXPECT_EQ(term->rows().lower, Eigen::Vector2d(-0.9, -0.9));
  EXPECT_EQ(term->rows().upper, Eigen::Vector2d(1.9, 1.9));
}

TEST_F(Constraint, OnParametersIsAWeightedSum) {
  const std::vector<std::string> names = {"body.arm.mass", "body.hand.mass"};
  const ConstraintPointer term =
      parameter_sum(set_, "mass", names, -kInfinity, 2.0, Eigen::Vector2d(1.0, 3.0));
  Eigen::VectorXd c(1);
  term->values(values_, c);
  EXPECT_NEAR(c[0], values_.p[set_.find(names[0])] + 3.0 * values_.p[set_.find(names[1])], 1e-12);
  expect_right_partials(*term, values_);
  expect_right_partials(*parameter_sum(set_, "mass", names, -kInfinity, 2.0), values_);
}

TEST_F(Constraint, ThatIsLinearIsAnyWeightedSumOfNumbers) {
  const ConstraintRows rows{{"a", "b"}, Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones()};
  const int readings = model_.variable_count();  // their first row
  const ConstraintPointer term =
      linear_constraint(rows,
                        {{1, Field::kMeasured, 3, readings + 2},
                         {0, Field::kU, 2, 0},
                         {1, Field::kMeasured, 3, readings}},
                        Eigen::Vector3d(2.0, -1.0, 0.5), Eigen::Vector2d(0.0, 7.0));
  Eigen::VectorXd c(2);
  term->values(values_, c);
  EXPECT_DOUBLE_EQ(c[0], -values_.u(0, 2));
  EXPECT_DOUBLE_EQ(c[1], 7.0 + 2.0 * values_.declared()(1, 3) + 2.0);
  expect_right_partials(*term, values_);
  EXPECT_TRUE(term->second_places().empty());
  EXPECT_THROW(static_cast<void>(linear_constraint(rows, {}, Eigen::VectorXd::Ones(1))),
               InvalidInput);
  EXPECT_THROW(
      static_cast<void>(linear_constraint(rows, {{0, Field::kU, 2, 0}}, Eigen::VectorXd::Ones(1),
                                          Eigen::VectorXd::Ones(3))),
      InvalidInput);
}

TEST_F(Constraint, ThatReadsANumberThatIsNotThereSaysWhich) {
  const ConstraintRows rows{{"a"}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
  const ConstraintPointer term =
      linear_constraint(rows, {{0, Field::kMeasured, 3, 9}}, Eigen::VectorXd::Ones(1));
  Eigen::VectorXd c(1);
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { term->values(values_, c); }),
            "there is no measured 9 at step 3: measured is 9 x 6");
}

/// u q̇ ≤ 1 written by hand.
ConstraintPointer hand_written_power(std::optional<RowSecondPartials> second) {
  const ConstraintRows rows{
      {"power"}, Eigen::VectorXd::Constant(1, -1.0), Eigen::VectorXd::Constant(1, 1.0)};
  return user_constraint(
      rows, {{0, Field::kU, 2, 0}, {0, Field::kQdot, 3, 6}},
      [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) {
        c[0] = values.u(0, 2) * values.qdot(6, 3);
      },
      [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> partials) {
        partials << values.qdot(6, 3), values.u(0, 2);
      },
      std::move(second));
}

TEST_F(Constraint, OfOnesOwnIsTakenAtItsWord) {
  const RowSecondPartials second{
      {{0, {Field::kU, 2, 0}, {Field::kQdot, 3, 6}}},
      [](const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd> out) { out[0] = 1.0; }};
  expect_right_partials(*hand_written_power(second), values_);
  const ConstraintPointer linear = hand_written_power(RowSecondPartials::of_linear_rows());
  EXPECT_TRUE(linear->second_places().empty());
  EXPECT_FALSE(check_constraint_term(*linear, values_).passed());
}

TEST_F(Constraint, OfOnesOwnWithoutSecondPartialsSaysWhatToDo) {
  const ConstraintPointer term = hand_written_power(std::nullopt);
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(term->second_places()); }),
            "constraint 'power' has no second partials; give user_constraint its second places "
            "and partials (or say that the rows are linear), write it as a generic_constraint, or "
            "use the limited-memory Hessian");
  EXPECT_FALSE(check_constraint_term(*term, values_).has_second);
  const SecondPlace place{1, {Field::kU, 2, 0}, {Field::kU, 2, 0}};
  EXPECT_THROW(static_cast<void>(hand_written_power(RowSecondPartials{{place}, {}})), InvalidInput);
  EXPECT_THROW(static_cast<void>(hand_written_power(RowSecondPartials{
                   {place}, [](const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>) {}})),
               InvalidInput);
}

TEST_F(Constraint, RefusesWhatMakesNoSense) {
  EXPECT_THROW(static_cast<void>(variable_at_step(model_, "tap", 1, {0.0, 0.0, 0.0})),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(variable_at_step(model_, "tip", -1, {0.0, 0.0, 0.0})),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(variable_at_step(model_, "tip", 1, {0.0, 0.0, 0.0}, -1.0)),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(coordinate_limits(model_, 99, {1}, 0.0, 1.0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(coordinate_limits(model_, 0, {1}, 1.0, 0.0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(joint_limits(model_, {1}, -0.1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(parameter_sum(set_, "mass", {"body.arm.mass"}, 0.0, 1.0,
                                               Eigen::Vector2d(1.0, 1.0))),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(parameter_sum(set_, "mass", {"body.arm.weight"}, 0.0, 1.0)),
               InvalidInput);
  const ConstraintRows rows{{"a"}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};
  EXPECT_THROW(static_cast<void>(user_constraint(rows, {{1, Field::kQ, 0, 0}}, {}, {})),
               InvalidInput);
}

}  // namespace
}  // namespace hbar
