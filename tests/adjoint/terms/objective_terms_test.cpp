#include "hbar/adjoint/terms/objective_terms.h"

#include <gtest/gtest.h>

#include <limits>

#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::message_of;

/// Weights of 5 steps, of which one step counts nothing.
StepWeights uneven() { return {(VectorXd(5) << 0.5, 1.0, 0.0, 2.0, 3.0).finished()}; }

std::vector<TermPointer> every_term() {
  testing::Random random(7);
  return {squared_variables(1.5),
          squared_variables(1.5, uneven()),
          squared_tactile(0.4),
          squared_tactile(0.4, uneven()),
          squared_measured(0.9),
          squared_measured(0.9, {11, 9}, uneven()),
          squared_final_position(0.5),
          tracking(random.matrix(4, 5), 2.0),
          tracking(random.vector(4), 2.0, uneven()),
          variable_tracking(random.matrix(6, 5), 0.7),
          variable_tracking(random.vector(6), 0.7, uneven()),
          measured_tracking({10}, random.matrix(1, 5), 1.3, uneven()),
          measured_tracking({}, random.matrix(3, 5), 1.3),
          tracking_of(ValueField::kMeasured, {6, 7, 8}, random.vector(3), 0.8),
          tracking_of(ValueField::kU, {1}, random.matrix(1, 5), 0.8, uneven()),
          terminal_state(random.vector(4), random.vector(4), 1.2, 0.3),
          terminal_state(random.vector(4), random.vector(4), 1.2, 0.0),
          effort(2.5),
          effort(2.5, uneven()),
          squared_velocity(1.1),
          squared_velocity(1.1, uneven()),
          control_smoothness(0.2),
          control_smoothness(0.2, uneven()),
          work({9, 11}, 0.5, 1.7),
          work({10}, 0.5, 1.7, uneven()),
          net_work({9, 11}, 1.7),
          time_integral(ValueField::kQdot, {3}, -0.6, uneven()),
          final_number(ValueField::kMeasured, 4, -2.0),
          final_number(ValueField::kU, 1, 2.0),
          weighted_numbers("price", {{ValueField::kP, 0, 1}, {ValueField::kQ, 3, 2}},
                           Eigen::Vector2d(0.7, -0.2)),
          user_term(
              "cubic", [](const TrajectoryValues& x) { return std::pow(x.p[1], 3); },
              [](const TrajectoryValues& x, TrajectoryPartials& partials) {
                partials.p[1] += 3.0 * x.p[1] * x.p[1];
              },
              {[](const TrajectoryValues&) {
                 const ValuePlace place{ValueField::kP, 0, 1};
                 return std::vector<SecondPlace>{{0, place, place}};
               },
               [](const TrajectoryValues& x, Eigen::Ref<VectorXd> second) {
                 second[0] = 6.0 * x.p[1];
               }})};
}

TEST(EveryTerm, HasExactPartialsAndNoIdleSecondPartials) {
  const TrajectoryValues values = testing::random_values(1);
  for (const TermPointer& term : every_term()) {
    const TermCheck check = check_objective_term(*term, values);
    EXPECT_TRUE(check.has_second) << term->name();
    EXPECT_TRUE(check.passed()) << term->name() << ": " << check.gap_name << ' '
                                << check.second_gap_name << ' ' << check.slope << ' '
                                << check.second_slope;
    EXPECT_LT(check.gap, 1e-10) << term->name();
    EXPECT_LT(check.second_gap, 1e-10) << term->name() << ' ' << check.second_gap_name;
    EXPECT_EQ(check.idle, 0) << term->name();
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
  values.v().setConstant(0.5);
  values.u.setConstant(4.0);
  // What happens at k = 0 is given, not caused: it counts nowhere.
  values.q.col(0).setConstant(1e3);
  values.qdot.col(0).setConstant(1e3);
  values.v().col(0).setConstant(1e3);
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

TEST(Terms, OfChangesAndMeasurementsHaveTheValuesOfTheirFormulas) {
  TrajectoryValues values = testing::random_values(3);
  values.h = 0.5;
  values.u.row(0) << 0.0, 1.0, 3.0, 3.0, 3.0;
  values.u.row(1).setConstant(7.0);
  EXPECT_DOUBLE_EQ(control_smoothness(2.0)->value(values), (1.0 + 4.0) / 0.5);
  EXPECT_DOUBLE_EQ(control_smoothness(2.0, uneven())->value(values), (1.0 * 1.0 + 0.0) / 0.5);
  values.declared().row(0) << 1e3, 4.0, -4.0, 0.0, 4.0, -4.0;
  values.declared().row(1).setConstant(1e3);
  EXPECT_DOUBLE_EQ(work({9}, 3.0, 2.0)->value(values), 2.0 * 0.5 * 4 * (5.0 - 3.0));
  EXPECT_NEAR(work({9}, 1e-9)->value(values), 0.5 * 16.0, 1e-8);
  EXPECT_DOUBLE_EQ(net_work({9}, 2.0)->value(values), 0.0);
  EXPECT_DOUBLE_EQ(net_work({10}, 2.0)->value(values), 2.0 * 0.5 * 5e3);
  EXPECT_DOUBLE_EQ(measured_tracking({9}, MatrixXd::Constant(1, 1, 4.0), 2.0)->value(values),
                   64.0 + 16.0 + 64.0);
  EXPECT_DOUBLE_EQ(final_number(ValueField::kMeasured, 9, -3.0)->value(values), 12.0);
  EXPECT_DOUBLE_EQ(final_number(ValueField::kU, 0, 2.0)->value(values), 6.0);
  EXPECT_DOUBLE_EQ(time_integral(ValueField::kU, {0}, 1.0)->value(values), 5.0);
}

TEST(Terms, CountStepsByTheirWeights) {
  TrajectoryValues values = testing::random_values(5);
  values.h = 0.1;
  values.q.setZero();
  values.u.setZero();
  values.q(1, 4) = 3.0;  // the end of step 4 …
  values.u(0, 3) = 2.0;  // … whose controls are u_3
  const StepWeights late = StepWeights::over_time(5, 0.1, [](double t) { return t; });
  EXPECT_DOUBLE_EQ(tracking(VectorXd::Zero(4), 2.0, late)->value(values), 0.4 * 9.0);
  EXPECT_DOUBLE_EQ(effort(2.0, late)->value(values), 0.1 * 0.4 * 4.0);
}

TEST(Terms, OfOnesOwnWithoutSecondPartialsSayWhatToDo) {
  const auto value = [](const TrajectoryValues&) { return 0.0; };
  const auto add = [](const TrajectoryValues&, TrajectoryPartials&) {};
  const TrajectoryValues values = testing::random_values(6);
  const TermPointer term = user_term("mine", value, add);
  VectorXd second(1);
  const std::string message =
      "objective term 'mine' has no second partials; give user_term its second places and "
      "partials, write it as a generic_term, or use the limited-memory Hessian";
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(term->second_places(values)); }),
            message);
  EXPECT_EQ(message_of<InvalidInput>([&] { term->second_partials(values, second); }), message);
  const auto no_places = [](const TrajectoryValues&) { return std::vector<SecondPlace>(); };
  EXPECT_THROW(static_cast<void>(user_term("half", value, add, {no_places, {}})), InvalidInput);
}

TEST(Terms, RefuseATargetOfAnotherShape) {
  const TrajectoryValues values = testing::random_values(4);
  const TermPointer wrong = tracking(MatrixXd::Zero(3, 5));
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(wrong->value(values)); }),
            "tracking: target of q is 3 x 5; it must be 4 x 5 or 4 x 1");
  const TermPointer late = variable_tracking(MatrixXd::Zero(6, 6));
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(late->value(values)); }),
            "variable_tracking: target of measured is 6 x 6; it must be 6 x 5 or 6 x 1");
  const TermPointer state = terminal_state(VectorXd::Zero(4), VectorXd::Zero(3), 1.0, 1.0);
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(state->value(values)); }),
            "terminal_state: target of qdot is 3 x 1; it must be 4 x 1");
}

TEST(Terms, RefuseAWeightThatIsNegativeOrNotFinite) {
  EXPECT_EQ(message_of<InvalidInput>([] { static_cast<void>(squared_variables(-1.0)); }),
            "squared_variables: weight is -1; it must be ≥ 0");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& make : std::vector<std::function<TermPointer(double)>>{
           [](double w) { return squared_variables(w); },
           [](double w) { return squared_tactile(w); },
           [](double w) { return squared_measured(w); }, squared_final_position,
           [](double w) { return effort(w); }, [](double w) { return squared_velocity(w); },
           [](double w) { return control_smoothness(w); },
           [](double w) { return work({9}, 0.1, w); }, [](double w) { return net_work({9}, w); },
           [](double w) { return measured_tracking({}, VectorXd::Zero(3), w); },
           [](double w) { return tracking(VectorXd::Zero(4), w); },
           [](double w) { return variable_tracking(VectorXd::Zero(6), w); },
           [](double w) { return terminal_state(VectorXd::Zero(4), VectorXd::Zero(4), w, 1.0); },
           [](double w) { return terminal_state(VectorXd::Zero(4), VectorXd::Zero(4), 1.0, w); }}) {
    EXPECT_THROW(static_cast<void>(make(-1.0)), InvalidInput);
    EXPECT_THROW(static_cast<void>(make(nan)), InvalidInput);
    EXPECT_NO_THROW(static_cast<void>(make(0.0)));
  }
}

TEST(Terms, RefuseRowsAndNumbersThatMakeNoSense) {
  const TrajectoryValues values = testing::random_values(4);
  const TermPointer none = squared_measured(1.0, {12});
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(none->value(values)); }),
            "squared_measured: there is no row 12 of measured; it has 12");
  EXPECT_THROW(static_cast<void>(squared_measured(1.0, {1, 1})), InvalidInput);
  EXPECT_THROW(static_cast<void>(work({9}, 0.0)), InvalidInput);
  EXPECT_THROW(static_cast<void>(work({}, 0.1)), InvalidInput);
  EXPECT_THROW(static_cast<void>(net_work({})), InvalidInput);
  const ValuePlace place{ValueField::kQ, 3, 2};
  EXPECT_THROW(static_cast<void>(weighted_numbers("a", {place}, VectorXd::Ones(2))), InvalidInput);
  EXPECT_THROW(static_cast<void>(weighted_numbers("a", {place, place}, VectorXd::Ones(2))),
               InvalidInput);
  const TermPointer far = weighted_numbers("a", {{ValueField::kQ, 6, 2}}, VectorXd::Ones(1));
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(far->value(values)); }),
            "there is no q 2 at step 6: q is 4 x 6");
  const TermPointer short_weights = control_smoothness(1.0, {VectorXd::Ones(4)});
  EXPECT_THROW(static_cast<void>(short_weights->value(values)), InvalidInput);
}

}  // namespace
}  // namespace hbar
