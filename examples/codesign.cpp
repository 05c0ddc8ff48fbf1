// The smallest co-design: from half a second on, the tip of a finger shall stay in a box beside it.
// Torques and the springs of two joints are chosen so that the torques are least.
#include <iostream>

#include "hbar/hbar.h"
#include "hbar/ipopt.h"

int main() {
  using namespace hbar;
  const Model model = scene::load_model("examples/scenes/finger.xml").model;
  const std::vector<ParameterBounds> springs = {{"joint.knuckle.stiffness", 0.0, 5.0},
                                                {"joint.middle_hinge.stiffness", 0.0, 5.0}};
  const auto set = ParameterSet::named(model, {springs[0].name, springs[1].name});
  const TrajectoryProblem problem{
      .horizon = Horizon(model, set, {.integrator = "bdf2", .h = 0.01, .steps = 100}),
      .map = parameter_map(set, springs),
      .objective = Objective(effort()),
      .constraints = {
          variable_limits(model, "tip", step_range(50, 100), {0.2, 0.05, -0.1}, {0.3, 0.1, 0.0})}};
  const auto program = transcribe(problem, {.formulation = Formulation::kAllAtOnce});
  const auto result =
      solvers::solve_with_ipopt(*program, {.hessian = solvers::HessianKind::kExact});
  std::cout << result.message << "\nstiffness: " << program->design(result.x).transpose() << '\n';
  return result.converged() ? 0 : 1;
}
