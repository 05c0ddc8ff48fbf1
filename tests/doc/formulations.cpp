// The snippets of doc/formulations.md, run on the finger of examples/scenes.

#include <gtest/gtest.h>

#include "hbar/hbar.h"
#include "hbar/ipopt.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

TEST(FormulationsPage, SolvesAProblemAllAtOnce) {
  const Model model = testing::example_model("finger.xml");
  const auto parameters =
      ParameterSet::named(model, {"joint.knuckle.stiffness", "joint.middle_hinge.stiffness"});
  const Eigen::Vector3d target(0.24, 0.08, -0.04);

  TrajectoryProblem problem{
      .horizon = Horizon(model, parameters, {.integrator = "bdf2", .h = 0.01, .steps = 100}),
      .map = parameter_map(parameters),  // what a designer may change
      .objective = Objective(effort()),
      .constraints = {variable_at_step(model, "tip", 100, target)}};
  problem.controls.hold = 5;  // steps per block of controls

  const auto program = transcribe(problem, {.formulation = Formulation::kAllAtOnce});
  const auto result =
      solvers::solve_with_ipopt(*program, {.hessian = solvers::HessianKind::kExact});
  const TrajectoryValues& motion = program->trajectory_values(result.x);

  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_LT((motion.v().col(100) - target).norm(), 1e-5);
  EXPECT_EQ(motion.u.col(0), motion.u.col(4));
  const Trajectory simulated = simulate(problem.horizon, program->inputs(result.x)).trajectory();
  EXPECT_LT((simulated.q_at_step(100) - motion.q.col(100)).norm(), 1e-4);
}

TEST(FormulationsPage, MultipliesByTheHessian) {
  const Model model = testing::example_model("finger.xml");
  const Horizon horizon(model, ParameterSet::named(model, {"body.distal.mass"}),
                        {.integrator = "bdf2", .h = 0.01, .steps = 30});
  const Objective objective(squared_variables());
  Inputs inputs = horizon.nominal_inputs();
  inputs.u.setConstant(0.3);
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  Inputs direction = horizon.nominal_inputs();
  direction.u.setConstant(0.5);
  direction.q0.setConstant(0.2);

  HessianProduct hessian(horizon, objective);
  const Gradient gradient = hessian.set_point(trajectory);
  const Gradient curvature = hessian.along(direction);  // shaped like the inputs

  const auto gradient_at = [&](double e) {
    Inputs moved = inputs;
    moved.p += e * direction.p;
    moved.u += e * direction.u;
    moved.q0 += e * direction.q0;
    return hbar::gradient(horizon, simulate(horizon, moved).trajectory(), objective);
  };
  const double e = 1e-4;
  const Gradient above = gradient_at(e);
  const Gradient below = gradient_at(-e);
  EXPECT_NEAR(gradient.value, gradient_at(0.0).value, 1e-14);
  EXPECT_LT((curvature.u - (above.u - below.u) / (2.0 * e)).norm(), 1e-6 * curvature.u.norm());
  EXPECT_LT((curvature.p - (above.p - below.p) / (2.0 * e)).norm(), 1e-6 * curvature.p.norm());
}

}  // namespace
}  // namespace hbar
