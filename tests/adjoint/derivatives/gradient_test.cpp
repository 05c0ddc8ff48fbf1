#include "hbar/adjoint/derivatives/gradient.h"

#include <gtest/gtest.h>

#include <atomic>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/chart.h"
#include "hbar/core/base/error.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/input_vector.h"
#include "tests/support/message_of.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using testing::flatten;
using testing::InputClass;
using testing::message_of;
using testing::relative_gap;

Horizon make_horizon(const Model& model, const std::string& integrator, double h, int steps,
                     bool keep_factors = true) {
  SimulationOptions options;
  options.integrator = integrator;
  options.h = h;
  options.steps = steps;
  options.keep_factors = keep_factors;
  return {model, ParameterSet::all(model), options};
}

/// Steps of central differences, from truncation error to rounding error.
const std::vector<double> kVCurve = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7};

/// Inputs of which none is zero and none is nominal.
Inputs random_inputs(const Horizon& horizon, unsigned seed) {
  testing::Random random(seed);
  Inputs inputs = horizon.nominal_inputs();
  // What is 0 may not be negative.
  const Eigen::VectorXd change = random.vector(inputs.p.size(), 0.01);
  inputs.p = (inputs.p.array() == 0.0).select(change.cwiseAbs(), inputs.p + change);
  inputs.u = 0.9 * random.matrix(inputs.u.rows(), inputs.u.cols());
  inputs.q0 = random.vector(inputs.q0.size(), 0.4);
  inputs.qdot0 = random.vector(inputs.qdot0.size(), 0.8);
  return inputs;
}

/// An objective with partials in q̄, q̇̄, v̄, u and p.
Objective full_objective(const Horizon& horizon) {
  const int dof = horizon.model().dof();
  testing::Random random(11);
  Objective objective(squared_variables(0.3));
  objective.add(tracking(random.matrix(dof, horizon.options().steps), 0.7))
      .add(terminal_state(random.vector(dof), random.vector(dof), 0.4, 0.2))
      .add(squared_velocity(0.5))
      .add(effort(2.0))
      .add(testing::near_parameters(horizon.parameters().nominal(), 1.3));
  return objective;
}

class GradientOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(GradientOfEveryIntegrator, AgreesWithCentralDifferencesInEveryClassOnEveryJoint) {
  const Model model = testing::random_model(21);
  Horizon horizon = make_horizon(model, GetParam(), 0.01, 5);
  const Inputs inputs = random_inputs(horizon, 1);
  const Objective objective = full_objective(horizon);
  const Gradient exact = gradient(horizon, simulate(horizon, inputs).trajectory(), objective);
  EXPECT_NEAR(exact.value, testing::objective_of(horizon, objective, inputs), 1e-14 * exact.value);
  const std::vector<InputClass> classes = testing::input_classes(horizon, inputs);
  // All kinds but the three of contact and sizes, which this model has none of, and three more.
  EXPECT_EQ(classes.size(), parameter_kinds().size() - 4 + 3);
  for (const InputClass& entries : classes) {
    EXPECT_LT(testing::gap_to_differences(horizon, objective, inputs, exact, entries, {1e-4}), 1e-6)
        << entries.name;
  }
}

TEST_P(GradientOfEveryIntegrator, LeavesATaylorRemainderOfSecondOrderInEveryClass) {
  const Model model = testing::random_model(22);
  Horizon horizon = make_horizon(model, GetParam(), 0.01, 5);
  const Inputs inputs = random_inputs(horizon, 2);
  const Objective objective = full_objective(horizon);
  const Gradient exact = gradient(horizon, simulate(horizon, inputs).trajectory(), objective);
  for (const InputClass& entries : testing::input_classes(horizon, inputs)) {
    const double slope = testing::taylor_slope_in(horizon, objective, inputs, exact, entries, 0.03);
    EXPECT_NEAR(slope, 2.0, 0.1) << entries.name;
  }
}

TEST_P(GradientOfEveryIntegrator, IsTheSameWithAndWithoutKeptFactors) {
  const Model model = testing::random_model(23);
  Horizon keeping = make_horizon(model, GetParam(), 0.01, 10);
  Horizon forgetting = make_horizon(model, GetParam(), 0.01, 10, false);
  const Inputs inputs = random_inputs(keeping, 3);
  const Objective objective = full_objective(keeping);
  const Trajectory trajectory = simulate(keeping, inputs).trajectory();
  const Trajectory bare = simulate(forgetting, inputs).trajectory();
  EXPECT_EQ(static_cast<int>(trajectory.factors.size()), trajectory.timeline.stage_count());
  EXPECT_TRUE(bare.factors.empty());
  AdjointSweep with(keeping);
  AdjointSweep without(forgetting);
  const Gradient reused = with.gradient(trajectory, objective);
  const Gradient factored = without.gradient(bare, objective);
  EXPECT_LT(relative_gap(flatten(reused), flatten(factored)), 1e-12);
  EXPECT_EQ(without.refactorized(), bare.timeline.last_stage());
  EXPECT_LT(with.worst_residual(), 1e-14);
  EXPECT_LT(without.worst_residual(), 1e-14);
}

/// A body that spins fast enough to leave its first chart.
struct Tumbling {
  Tumbling(const std::string& integrator, const Eigen::Vector3d& r0)
      : horizon(make_horizon(testing::single_body(Free3dExpJoint{}, testing::kGravity, 0.2, 0.1),
                             integrator, 0.02, 60)),
        inputs(horizon.nominal_inputs()),
        objective(squared_variables()) {
    inputs.q0 << 0.1, -0.2, 0.3, r0;
    inputs.qdot0 << 0.4, 0.5, 1.0, 6.0, -8.0, 5.0;
    objective.add(squared_velocity(0.01))
        .add(testing::final_variables(Eigen::Vector3d(1.0, 2.0, 3.0)));
  }
  Horizon horizon;
  Inputs inputs;
  Objective objective;
};

void expect_exact(Tumbling& scene) {
  const Trajectory trajectory = simulate(scene.horizon, scene.inputs).trajectory();
  const Gradient exact = gradient(scene.horizon, trajectory, scene.objective);
  for (const InputClass& entries : testing::input_classes(scene.horizon, scene.inputs)) {
    EXPECT_LT(testing::gap_to_differences(scene.horizon, scene.objective, scene.inputs, exact,
                                          entries, kVCurve),
              1e-6)
        << entries.name;
    EXPECT_NEAR(testing::taylor_slope_in(scene.horizon, scene.objective, scene.inputs, exact,
                                         entries, 0.03),
                2.0, 0.1)
        << entries.name;
  }
}

TEST_P(GradientOfEveryIntegrator, IsExactThroughAChangeOfChart) {
  Tumbling scene(GetParam(), {0.3, 0.2, -0.4});
  const Trajectory trajectory = simulate(scene.horizon, scene.inputs).trajectory();
  ASSERT_GE(trajectory.chart_switches.size(), 1U);
  EXPECT_LT(trajectory.chart_switches.back().stage, trajectory.timeline.last_stage() - 3);
  expect_exact(scene);
}

TEST_P(GradientOfEveryIntegrator, IsExactWhereTheInitialStateIsBeyondTheChart) {
  Tumbling scene(GetParam(), Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0 * (kChartLimit + 0.4));
  const Trajectory trajectory = simulate(scene.horizon, scene.inputs).trajectory();
  ASSERT_GE(trajectory.chart_switches.size(), 1U);
  EXPECT_EQ(trajectory.chart_switches.front().stage, 0);
  expect_exact(scene);
}

INSTANTIATE_TEST_SUITE_P(All, GradientOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

/// Inputs that swing the stiff pendulum into its limit.
Inputs swing(const Horizon& horizon) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.15, 0.1;
  inputs.qdot0 << 3.0, -0.5;
  inputs.u.setConstant(0.3);
  return inputs;
}

class GradientAfterHalvedSteps : public ::testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(GradientAfterHalvedSteps, StillAgreesWithCentralDifferences) {
  const auto& [integrator, implicit_motor] = GetParam();
  SimulationOptions options;
  options.integrator = integrator;
  options.h = 0.01;
  options.steps = 12;
  options.newton.max_iter = 3;  // too few at the limit's onset with the whole step
  const Model model = testing::stiff_pendulum(implicit_motor);
  Horizon horizon(model, ParameterSet::all(model), options);
  const Inputs inputs = swing(horizon);
  const Rollout rollout = simulate(horizon, inputs);
  const Trajectory& trajectory = rollout.trajectory();
  const int stages = simulate(horizon, horizon.nominal_inputs()).partial().timeline.stage_count();
  EXPECT_GT(trajectory.timeline.stage_count(), stages);
  EXPECT_LT(rollout.report().smallest_h, options.h);
  EXPECT_GT(trajectory.q.row(0).maxCoeff(), 0.2);
  Objective objective(squared_variables());
  objective.add(squared_velocity());
  const Gradient exact = gradient(horizon, trajectory, objective);
  for (const InputClass& entries : testing::input_classes(horizon, inputs)) {
    EXPECT_LT(testing::gap_to_differences(horizon, objective, inputs, exact, entries, kVCurve),
              1e-6)
        << entries.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, GradientAfterHalvedSteps,
                         ::testing::Values(std::tuple<std::string, bool>("bdf1", false)));

TEST(AdjointSweep, PullsBackGivenPartials) {
  const Model model = testing::double_pendulum();
  Horizon horizon = make_horizon(model, "bdf2", 0.01, 20);
  const Inputs inputs = random_inputs(horizon, 4);
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  const Objective objective = full_objective(horizon);
  const TrajectoryValues values = read_values(horizon, trajectory);
  AdjointSweep sweep(horizon);
  const Gradient whole = sweep.gradient(trajectory, objective);
  const Gradient given = sweep.pull_back(trajectory, objective.partials(values));
  EXPECT_EQ(flatten(whole), flatten(given));
  EXPECT_EQ(given.value, 0.0);
  TrajectoryPartials twice = objective.partials(values);
  for (Eigen::MatrixXd* part : {&twice.q, &twice.qdot, &twice.measured, &twice.u}) {
    *part *= 2.0;
  }
  twice.p *= 2.0;
  EXPECT_LT(relative_gap(flatten(sweep.pull_back(trajectory, twice)), 2.0 * flatten(whole)), 1e-14);
}

TEST_P(GradientOfEveryIntegrator, NeedsNoNewFactorsOnASmoothMotion) {
  Horizon horizon = make_horizon(testing::double_pendulum(), GetParam(), 0.005, 100);
  const Inputs inputs = random_inputs(horizon, 5);
  AdjointSweep sweep(horizon);
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  const Gradient gradient = sweep.gradient(trajectory, full_objective(horizon));
  EXPECT_GT(gradient.value, 0.0);
  EXPECT_EQ(sweep.refactorized(), 0);
  EXPECT_LT(sweep.worst_residual(), 1e-14);
}

TEST(AdjointSweep, EndsWhenAskedAndIsUnchangedByAFlagThatIsNotSet) {
  std::atomic<bool> stop = false;
  const Horizon plain = make_horizon(testing::double_pendulum(), "bdf2", 0.01, 20);
  SimulationOptions options = plain.options();
  options.stop = &stop;
  const Horizon watched = plain.with(options);
  const Inputs inputs = random_inputs(plain, 3);
  const Trajectory trajectory = simulate(watched, inputs).trajectory();
  const Objective objective(squared_variables());
  const Gradient found = gradient(watched, trajectory, objective);
  const Gradient expected = gradient(plain, simulate(plain, inputs).trajectory(), objective);
  EXPECT_EQ(flatten(found), flatten(expected));
  EXPECT_EQ(found.value, expected.value);
  stop = true;
  EXPECT_EQ(
      message_of<Interrupted>([&] { static_cast<void>(gradient(watched, trajectory, objective)); }),
      "backward sweep interrupted at stage 21 of 21");
}

TEST(AdjointSweep, RefusesASingularBlock) {
  const Model model = testing::slider(0.0, testing::kGravity);
  Horizon horizon = make_horizon(model, "bdf1", 0.5, 3);
  Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();
  // A stiffness that cancels the inertia: 2 / h² + k = 0, exactly.
  trajectory.factors.clear();
  auto mechanism = std::make_shared<Mechanism<double>>(*trajectory.mechanism);
  mechanism->stiffness[0] = -8.0;
  trajectory.mechanism = mechanism;
  const auto sweep = [&] {
    static_cast<void>(gradient(horizon, trajectory, Objective(squared_final_position())));
  };
  const std::string message = message_of<NumericalFailure>(sweep);
  EXPECT_NE(message.find("adjoint: the block of stage 3 (t = 1.5) is singular"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace hbar
