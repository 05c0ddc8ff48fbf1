#include "swing_up.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::swing_up {
namespace {

/// Cart at the middle, lower rod turned over, upper rod in line with it.
Eigen::Vector3d upright() { return {0.0, std::numbers::pi, 0.0}; }

void require_cart(const Model& model) {
  const bool cart = model.dof() == 3 && model.motors().size() == 1 &&
                    model.coordinates_of_link(model.motors().front().link).begin == 0 &&
                    model.motors().front().kind == Motor::Kind::kForce;
  if (!cart) {
    throw InvalidInput(
        "swing_up: the scene must have three coordinates, slider, hinge and hinge, and one motor, "
        "a "
        "force on the slider");
  }
}

std::vector<ConstraintPointer> swing_up_constraints(const Model& model, int steps) {
  std::vector<ConstraintPointer> out;
  for (int c = 0; c < model.dof(); ++c) {
    out.push_back(coordinate_limits(model, c, {steps}, upright()[c], upright()[c]));
    out.push_back(rate_limits(model, c, {steps}, 0.0, 0.0));
  }
  if (steps > 1) {
    out.push_back(joint_limits(model, step_range(1, steps - 1), kTrackMargin));
  }
  return out;
}

}  // namespace

SwingUp make_swing_up(const std::filesystem::path& scene, int steps) {
  const Model model = scene::build_model(scene::read_scene(scene));
  require_cart(model);
  SimulationOptions simulation;
  simulation.integrator = "bdf2";
  simulation.h = kDuration / steps;
  simulation.steps = steps;
  ParameterSet set;  // nothing of the cart is looked for
  auto map = parameter_map(set);
  Objective objective(effort());
  objective.add(control_smoothness(kSmoothness));
  HeldControls controls;
  controls.lower = Eigen::VectorXd::Constant(1, -1.0);
  controls.upper = Eigen::VectorXd::Constant(1, 1.0);
  return {.problem = {.horizon = Horizon(model, std::move(set), simulation),
                      .map = std::move(map),
                      .objective = std::move(objective),
                      .constraints = swing_up_constraints(model, steps),
                      .controls = std::move(controls),
                      .q0 = Eigen::VectorXd::Zero(3),
                      .qdot0 = Eigen::VectorXd::Zero(3)},
          .q_guess = upright() * Eigen::RowVectorXd::LinSpaced(steps + 1, 0.0, 1.0)};
}

std::unique_ptr<Transcription> transcribe_swing_up(const SwingUp& swing_up,
                                                   TranscriptionOptions options) {
  options.q_guess = swing_up.q_guess;
  return transcribe(swing_up.problem, options);
}

solvers::IpoptOptions ipopt_options() {
  solvers::IpoptOptions options;
  options.tolerance = 1e-8;
  options.constraint_tolerance = 1e-8;
  return options;
}

solvers::IpoptOptions fixed_barrier_options(double mu) {
  solvers::IpoptOptions options = ipopt_options();
  options.tolerance = 1e-11;
  options.number_options["mu_init"] = mu;
  options.number_options["mu_target"] = mu;
  return options;
}

double upright_error(const TrajectoryValues& values) {
  return std::max((values.q.rightCols<1>() - upright()).lpNorm<Eigen::Infinity>(),
                  values.qdot.rightCols<1>().lpNorm<Eigen::Infinity>());
}

}  // namespace hbar::swing_up
