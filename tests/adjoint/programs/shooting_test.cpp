#include "hbar/adjoint/programs/shooting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/solvers/nlp/gradient_check.h"
#include "tests/support/numerics.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using Field = PartialPlace::Field;
using testing::kInfinity;

/// Every field is read by some row; the last block of controls is a short one.
TrajectoryProblem small_parts(const std::string& integrator) {
  Problem problem = testing::make_problem(testing::small_model(), integrator, 0.02, 14);
  const Model model = problem.horizon.model();
  ParameterSet set = ParameterSet::named(
      model, {"joint.hinge.translation", "body.arm", "body.hand.mass", "joint.ball.damping"});
  const SimulationOptions options = problem.horizon.options();
  const ConstraintRows own{
      {"power", "rate"}, Eigen::VectorXd::Constant(2, -9.0), Eigen::VectorXd::Constant(2, 9.0)};
  std::vector<ConstraintPointer> constraints = {
      variable_at_step(model, "tip", 14, {0.1, 0.2, 0.3}, 0.1),
      variable_at_step(model, "corner", 5, {0.1, 0.2, 0.3}),
      coordinate_limits(model, 6, {0, 4, 9, 14}, -3.0, 3.0),
      parameter_sum(set, "mass", {"body.arm.mass", "body.hand.mass"}, 0.0, 10.0),
      user_constraint(
          own, {{0, Field::kU, 6, 0}, {0, Field::kQdot, 7, 6}, {1, Field::kQdot, 14, 2}},
          [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) {
            c << values.u(0, 6) * values.qdot(6, 7), values.qdot(2, 14);
          },
          [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> partials) {
            partials << values.qdot(6, 7), values.u(0, 6), 1.0;
          })};
  HeldControls controls;
  controls.hold = 4;
  controls.start = problem.inputs.u.leftCols(4);
  auto map = inertia_chart(set);
  return {.horizon = Horizon(model, set, options),
          .map = std::move(map),
          .objective = problem.objective,
          .constraints = std::move(constraints),
          .controls = std::move(controls),
          .q0 = problem.inputs.q0,
          .qdot0 = problem.inputs.qdot0,
          .design_weight = 0.3};
}

class ShootingOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(ShootingOfEveryIntegrator, HasRightGradientsAndJacobians) {
  Shooting problem(small_parts(GetParam()), {});
  solvers::validate(problem);
  Eigen::VectorXd x = problem.variables().start;
  x[0] += 0.01;  // away from the design's start, where the weight on it has no gradient
  const solvers::GradientCheck check = solvers::check_gradients(problem, x);
  EXPECT_LT(check.gap, 1e-6) << check.gap_name;
  EXPECT_GT(check.slope, 1.9) << check.slope_name;
}

INSTANTIATE_TEST_SUITE_P(All, ShootingOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& c) { return c.param; });

TEST(Shooting, NamesAndPlacesItsVariables) {
  Shooting problem(small_parts("bdf2"), {});
  const solvers::NlpVariables& variables = problem.variables();
  const Eigen::Index d = problem.problem().map->variables().size();
  const int controls = problem.problem().horizon.model().control_count();
  EXPECT_EQ(problem.input_variables().block_count(), 4);
  ASSERT_EQ(variables.start.size(), d + 4 * controls);
  EXPECT_EQ(variables.names[0], "joint.hinge.translation.x");
  EXPECT_EQ(variables.names[static_cast<std::size_t>(d + controls)], "control.hinge from step 4");
  Eigen::VectorXd x = variables.start;
  x[d + controls] = 7.0;
  const Inputs inputs = problem.inputs(x);
  EXPECT_EQ(inputs.u(0, 4), 7.0);
  EXPECT_EQ(inputs.u(0, 7), 7.0);
  EXPECT_NE(inputs.u(0, 3), 7.0);
  EXPECT_NE(inputs.u(0, 8), 7.0);
  EXPECT_EQ(inputs.q0, problem.problem().q0);
}

TEST(Shooting, LeavesOutWhatLaterControlsCannotDo) {
  Shooting problem(small_parts("bdf2"), {});
  const Eigen::Index d = problem.problem().map->variables().size();
  const int controls = problem.problem().horizon.model().control_count();
  const auto& names = problem.constraint_limits().names;
  const auto entries = [&](const std::string& name) {
    const auto row = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
    const auto& rows = problem.jacobian_pattern().rows;
    return std::count(rows.begin(), rows.end(), row);
  };
  EXPECT_EQ(entries("mass"), 2);
  EXPECT_EQ(entries("hinge at step 0"), 0);
  EXPECT_EQ(entries("hinge at step 4"), d + controls);
  EXPECT_EQ(entries("corner.x at step 5"), d + 2 * controls);
  EXPECT_EQ(entries("power"), d + 2 * controls);
  EXPECT_EQ(entries("tip.z at step 14"), d + 4 * controls);
}

TEST(Shooting, SimulatesAPointOnceAndDifferentiatesWhenAsked) {
  Shooting problem(small_parts("bdf1"), {});
  const Eigen::VectorXd x = problem.variables().start;
  Eigen::VectorXd c(problem.constraint_limits().lower.size());
  EXPECT_GT(problem.objective(x), 0.0);
  problem.constraints(x, c);
  EXPECT_EQ(problem.times().simulations, 1);
  EXPECT_EQ(problem.times().gradients + problem.times().jacobians, 0);
  Eigen::VectorXd g(x.size());
  problem.objective_gradient(x, g);
  EXPECT_EQ(problem.times().simulations, 1);
  EXPECT_EQ(problem.times().gradients, 1);
}

TEST(Shooting, FailsAPointThatCannotBe) {
  Shooting problem(small_parts("bdf1"), {});
  const Eigen::VectorXd start = problem.variables().start;
  const auto& names = problem.variables().names;
  const auto mass = std::find(names.begin(), names.end(), "body.arm.mass") - names.begin();
  Eigen::VectorXd x = start;
  x[mass] = -1.0;
  EXPECT_THROW(static_cast<void>(problem.objective(x)), solvers::EvaluationError);
  Eigen::VectorXd c(problem.constraint_limits().lower.size());
  EXPECT_THROW(problem.constraints(x, c), solvers::EvaluationError);
  EXPECT_EQ(problem.times().simulations, 1);
  x = start;
  x.tail<1>()[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(problem.objective(x)), solvers::EvaluationError);
  EXPECT_NO_THROW(static_cast<void>(problem.objective(start)));
  EXPECT_THROW(static_cast<void>(problem.objective(start.head(3))), InvalidInput);
}

TEST(Shooting, FailsAPointWhoseSimulationFails) {
  TrajectoryProblem parts = small_parts("bdf1");
  SimulationOptions options = parts.horizon.options();
  options.newton.max_iter = 1;
  options.max_halvings = 0;
  parts.horizon = Horizon(parts.horizon.model(), parts.horizon.parameters(), options);
  Shooting problem(parts, {});
  EXPECT_THROW(static_cast<void>(problem.objective(problem.variables().start)),
               solvers::EvaluationError);
}

TEST(Shooting, ControlsAMechanismThatIsNotDesigned) {
  TrajectoryProblem parts = small_parts("bdf2");
  const Model model = parts.horizon.model();
  parts.horizon = Horizon(model, ParameterSet(), parts.horizon.options());
  parts.map = parameter_map(ParameterSet());
  parts.constraints.erase(parts.constraints.begin() + 3);  // on parameters
  parts.controls.scale = Eigen::VectorXd::Constant(model.control_count(), 0.5);
  Shooting problem(parts, {});
  EXPECT_EQ(problem.variables().start.size(), 4 * model.control_count());
  const solvers::GradientCheck check = solvers::check_gradients(problem, problem.variables().start);
  EXPECT_LT(check.gap, 1e-6) << check.gap_name;
}

TEST(Shooting, RefusesPartsThatDoNotFit) {
  const auto expect_refused = [](const auto& spoil) {
    TrajectoryProblem parts = small_parts("bdf1");
    spoil(parts);
    EXPECT_THROW(Shooting(parts, {}), InvalidInput);
  };
  expect_refused([](TrajectoryProblem& parts) { parts.map = nullptr; });
  expect_refused([](TrajectoryProblem& parts) { parts.controls.hold = 0; });
  expect_refused([](TrajectoryProblem& parts) { parts.controls.start.resize(1, 1); });
  expect_refused([](TrajectoryProblem& parts) { parts.controls.lower.resize(1); });
  expect_refused([](TrajectoryProblem& parts) { parts.q0.resize(1); });
  expect_refused([](TrajectoryProblem& parts) { parts.design_weight = -1.0; });
  expect_refused([](TrajectoryProblem& parts) {
    parts.constraints.push_back(
        coordinate_limits(parts.horizon.model(), 0, {15}, -kInfinity, kInfinity));
  });
}

}  // namespace
}  // namespace hbar
