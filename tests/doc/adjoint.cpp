// The snippets of doc/adjoint.md, run on the arm of examples/scenes.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "hbar/hbar.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

/// A second of the arm, whose motors swing it to and fro once in that time.
Problem swinging_arm() {
  constexpr int kSteps = 50;
  const Model model = testing::example_model("arm.xml");
  const auto parameters = ParameterSet::named(model, {"body.payload.mass", "joint.elbow.damping"});
  const Horizon horizon(model, parameters,
                        {.integrator = "bdf2", .h = 1.0 / kSteps, .steps = kSteps});
  Inputs inputs = horizon.nominal_inputs();
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 1) / kSteps;
    inputs.u.col(k) << 0.2 * std::sin(angle), 0.1 * std::cos(angle), 0.1 * std::sin(angle);
  }
  Objective objective(squared_variables());
  objective.add(squared_velocity(0.1));
  return {horizon, objective, inputs};
}

TEST(AdjointPage, SweepsOrSolvesWithMatrices) {
  const auto [horizon, objective, inputs] = swinging_arm();
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();

  const Gradient swept = gradient(horizon, trajectory, objective);
  const Gradient assembled = gradient(horizon, trajectory, objective, solver_factory("klu"));

  testing::expect_same(swept, assembled);
}

TEST(AdjointPage, FindsAPeriodicOrbitAndItsGradient) {
  const Problem problem = swinging_arm();
  const auto& [horizon, objective, inputs] = problem;

  PeriodicSolver periodic(horizon, {.solver = solver_factory("auto")});
  const PeriodicOrbit orbit = periodic.solve(inputs);
  const Gradient gradient = periodic.gradient(orbit.trajectory, objective);  // by p and u

  const Trajectory& found = orbit.trajectory;
  const Trajectory again = simulate(horizon, found.inputs).trajectory();
  EXPECT_LT((again.q_at_step(horizon.steps()) - found.inputs.q0).norm(), 1e-8);
  EXPECT_LT((again.qdot_at_step(horizon.steps()) - found.inputs.qdot0).norm(), 1e-7);

  const auto value_with_payload = [&problem](double mass) {
    Inputs changed = problem.inputs;
    changed.p[0] = mass;
    const PeriodicOrbit near = solve_periodic(problem.horizon, changed);
    return problem.objective.value(read_values(problem.horizon, near.trajectory));
  };
  const double step = 1e-4 * inputs.p[0];
  const double difference =
      (value_with_payload(inputs.p[0] + step) - value_with_payload(inputs.p[0] - step)) /
      (2.0 * step);
  EXPECT_NEAR(gradient.p[0], difference, 1e-5 * std::abs(difference));
}

TEST(AdjointPage, ChecksAGradient) {
  const auto [horizon, objective, inputs] = swinging_arm();

  const GradientCheckReport report = check_gradient({horizon, objective, inputs});
  std::cout << report.table();

  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.rows.size(), 5U);  // masses, damping, controls, initial position and velocity
}

}  // namespace
}  // namespace hbar
