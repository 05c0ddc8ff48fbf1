#include "hbar/adjoint/objective_terms.h"

#include <gtest/gtest.h>

#include <limits>

#include "hbar/core/error.h"
#include "tests/adjoint/random_values.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::message_of;
using testing::relative_gap;

std::vector<TermPointer> every_term() {
  testing::Random random(7);
  return {squared_variables(1.5),
          squared_final_position(0.5),
          tracking(random.matrix(4, 5), 2.0),
          tracking(random.vector(4), 2.0),
          variable_tracking(random.matrix(6, 5), 0.7),
          variable_tracking(random.vector(6), 0.7),
          terminal_state(random.vector(4), random.vector(4), 1.2, 0.3),
          effort(2.5),
          squared_velocity(1.1),
          user_term(
              "cubic", [](const TrajectoryValues& x) { return std::pow(x.p[1], 3); },
              [](const TrajectoryValues& x, TrajectoryPartials& partials) {
                partials.p[1] += 3.0 * x.p[1] * x.p[1];
              })};
}

TEST(EveryTerm, HasPartialsThatAgreeWithDifferences) {
  const TrajectoryValues values = testing::random_values(1);
  for (const TermPointer& term : every_term()) {
    const auto value = [&](const VectorXd& x) -> VectorXd {
      return VectorXd::Constant(1, term->value(testing::with_values(x, values)));
    };
    const MatrixXd expected = testing::differences(value, testing::flatten_values(values));
    TrajectoryPartials partials(values);
    term->add_partials(values, partials);
    EXPECT_LT(relative_gap(testing::flatten_values(partials), expected.row(0).transpose()), 1e-10)
        << term->name();
  }
}

TEST(EveryTerm, AddsItsPartialsToWhatIsThere) {
  const TrajectoryValues values = testing::random_values(2);
  for (const TermPointer& term : every_term()) {
    TrajectoryPartials once(values);
    term->add_partials(values, once);
    TrajectoryPartials twice(values);
    term->add_partials(values, twice);
    term->add_partials(values, twice);
    EXPECT_EQ(testing::flatten_values(twice), 2.0 * testing::flatten_values(once)) << term->name();
  }
}

TEST(Terms, HaveTheValuesOfTheirFormulas) {
  TrajectoryValues values = testing::random_values(3);
  values.h = 0.5;
  values.q.setConstant(3.0);
  values.qdot.setConstant(-2.0);
  values.v.setConstant(0.5);
  values.u.setConstant(4.0);
  // What happens at k = 0 is given, not caused: it counts nowhere.
  values.q.col(0).setConstant(1e3);
  values.qdot.col(0).setConstant(1e3);
  values.v.col(0).setConstant(1e3);
  EXPECT_DOUBLE_EQ(squared_variables(2.0)->value(values), 5 * 6 * 0.25);
  EXPECT_DOUBLE_EQ(squared_final_position(2.0)->value(values), 4 * 9.0);
  EXPECT_DOUBLE_EQ(tracking(VectorXd::Constant(4, 1.0), 2.0)->value(values), 5 * 4 * 4.0);
  EXPECT_DOUBLE_EQ(variable_tracking(VectorXd::Constant(6, 1.5), 2.0)->value(values), 5 * 6 * 1.0);
  const TermPointer terminal =
      terminal_state(VectorXd::Constant(4, 1.0), VectorXd::Zero(4), 2.0, 4.0);
  EXPECT_DOUBLE_EQ(terminal->value(values), 4 * 4.0 + 2.0 * 4 * 4.0);
  EXPECT_DOUBLE_EQ(effort(2.0)->value(values), 0.5 * 5 * 2 * 16.0);
  EXPECT_DOUBLE_EQ(squared_velocity(2.0)->value(values), 0.5 * 5 * 4 * 4.0);
}

TEST(Terms, RefuseATargetOfAnotherShape) {
  const TrajectoryValues values = testing::random_values(4);
  const TermPointer wrong = tracking(MatrixXd::Zero(3, 5));
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(wrong->value(values)); }),
            "tracking: target is 3 x 5; it must be 4 x 5 or 4 x 1");
  const TermPointer late = variable_tracking(MatrixXd::Zero(6, 6));
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(late->value(values)); }),
            "variable_tracking: target is 6 x 6; it must be 6 x 5 or 6 x 1");
  const TermPointer state = terminal_state(VectorXd::Zero(4), VectorXd::Zero(3), 1.0, 1.0);
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(state->value(values)); }),
            "terminal_state: q has 4 and qdot 3 entries; they must have 4");
}

TEST(Terms, RefuseAWeightThatIsNegativeOrNotFinite) {
  EXPECT_EQ(message_of<InvalidInput>([] { static_cast<void>(squared_variables(-1.0)); }),
            "squared_variables: weight is -1; it must be ≥ 0");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& make : std::vector<std::function<TermPointer(double)>>{
           squared_variables, squared_final_position, effort, squared_velocity,
           [](double w) { return tracking(VectorXd::Zero(4), w); },
           [](double w) { return variable_tracking(VectorXd::Zero(6), w); },
           [](double w) { return terminal_state(VectorXd::Zero(4), VectorXd::Zero(4), w, 1.0); },
           [](double w) { return terminal_state(VectorXd::Zero(4), VectorXd::Zero(4), 1.0, w); }}) {
    EXPECT_THROW(static_cast<void>(make(-1.0)), InvalidInput);
    EXPECT_THROW(static_cast<void>(make(nan)), InvalidInput);
    EXPECT_NO_THROW(static_cast<void>(make(0.0)));
  }
}

}  // namespace
}  // namespace hbar
