// The snippets of doc/terms.md, run on the finger and the box of examples/scenes.

#include <gtest/gtest.h>

#include <cmath>

#include "hbar/hbar.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

/// A finger beside a box that stands on the ground; the force between them is measured.
Horizon grip_horizon() {
  const Model model = testing::example_model("rotate_box.xml");
  return {
      model,
      {},
      {.integrator = "bdf1",
       .h = 0.005,
       .steps = 20,
       .measurements = {ContactForce{.name = "grip", .contact = model.find_contact("tip-box")}}}};
}

/// Made-up values of every kind, none of them zero.
TrajectoryValues made_up_values(const Horizon& horizon) {
  TrajectoryValues values = value_shape(horizon);
  int n = 0;
  const auto fill = [&n](auto& numbers) {
    for (double& number : numbers.reshaped()) {
      number = std::sin(static_cast<double>(++n));
    }
  };
  fill(values.q);
  fill(values.qdot);
  fill(values.measured);
  fill(values.u);
  return values;
}

TEST(TermsPage, WeighsStepsByTime) {
  const Horizon horizon = grip_horizon();
  const int N = horizon.steps();
  const double h = horizon.options().h;
  const Eigen::VectorXd target = Eigen::VectorXd::Constant(horizon.model().dof(), 0.1);

  const auto late = StepWeights::over_time(N, h, [](double t) { return t; });
  Objective objective(tracking(target, 1.0, late));
  objective.add(effort(1e-3)).add(control_smoothness(1e-4));

  TrajectoryValues values = value_shape(horizon);
  values.q.setConstant(0.1);
  EXPECT_EQ(objective.value(values), 0.0);
  values.q(0, N) += 1.0;  // a miss at the end, t = N h
  EXPECT_NEAR(objective.value(values), 0.5 * N * h, 1e-15);
  for (const auto& term : objective.terms()) {
    EXPECT_TRUE(check_objective_term(*term, made_up_values(horizon)).passed()) << term->name();
  }
}

TEST(TermsPage, LimitsAMeasurementAndTheControlsRate) {
  const Horizon horizon = grip_horizon();
  const Model& model = horizon.model();
  const int N = horizon.steps();
  std::vector<ConstraintPointer> constraints;

  const int grip = horizon.measured_index("grip.normal");
  constraints.push_back(
      value_limits("grip", ValueField::kMeasured, grip, step_range(10, N), 2.0, 20.0));
  constraints.push_back(control_rate(model, N, Eigen::VectorXd::Constant(1, 0.2)));

  EXPECT_EQ(constraints[0]->rows().size(), N - 9);
  EXPECT_EQ(constraints[0]->rows().names[0], "grip at step 10");
  EXPECT_EQ(constraints[1]->rows().size(), model.control_count() * (N - 1));
  for (const auto& constraint : constraints) {
    const TermCheck check = check_constraint_term(*constraint, made_up_values(horizon));
    EXPECT_TRUE(check.passed()) << check.gap_name;
  }
}

TEST(TermsPage, DifferentiatesACustomFormula) {
  const Horizon horizon = grip_horizon();
  const Model& model = horizon.model();
  const int N = horizon.steps();
  Objective objective;

  const auto distance = [](auto x) {
    using std::sqrt;  // for double; the other number types bring their own
    return sqrt(x[0] * x[0] + x[1] * x[1] + 1e-6);
  };
  objective.add(generic_term(
      "distance",
      {place::end_effector(model, "tip", kX, N), place::end_effector(model, "tip", kY, N)},
      distance));

  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();
  const TrajectoryValues values = read_values(horizon, trajectory);
  EXPECT_NEAR(objective.value(values), values.v().col(N).head<2>().norm(), 1e-4);
  const TermCheck check = check_objective_term(*objective.terms()[0], made_up_values(horizon));
  EXPECT_TRUE(check.has_second);
  EXPECT_TRUE(check.passed()) << check.gap_name << ' ' << check.second_gap_name;
}

}  // namespace
}  // namespace hbar
