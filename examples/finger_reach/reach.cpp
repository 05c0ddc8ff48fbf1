#include "reach.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "hbar/core/dynamics/dynamics.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::finger_reach {
namespace {

const Eigen::Vector4d kStart(0.0, 0.4, 0.5, 0.4);  // yaw and three bends, rad

/// The shares of the motors' torques that hold a posture of the nominal finger.
Eigen::VectorXd holding_controls(const Model& model, const Eigen::VectorXd& q) {
  const Mechanism<double> mechanism = nominal_mechanism<double>(model);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(model.dof());
  Motion<double> motion(model.tree());
  compute_motion<double>(model.tree(), mechanism, q, none, none, motion);
  Dynamics<double> dynamics(model);
  Eigen::VectorXd tau(model.dof());
  inverse_dynamics<double>(model, mechanism, motion, dynamics, tau);
  Eigen::VectorXd u(model.control_count());
  for (std::size_t m = 0; m < model.motors().size(); ++m) {
    const Motor& motor = model.motors()[m];
    u[model.first_control(static_cast<int>(m))] =
        tau[model.coordinates_of_link(motor.link).begin] / motor.upper;
  }
  return u;
}

void require_finger(const Model& model) {
  const auto symmetric = [](const Motor& motor) {
    return motor.kind == Motor::Kind::kForce && motor.lower == -motor.upper;
  };
  if (model.dof() != 4 || model.motors().size() != 4 || model.end_effectors().size() != 1 ||
      !std::all_of(model.motors().begin(), model.motors().end(), symmetric)) {
    throw InvalidInput(
        "finger: the scene must have four hinges, each with a force motor of range \"-t t\", and "
        "one end effector");
  }
}

std::vector<std::string> weighed_bodies(const std::array<Phalanx, 3>& phalanges) {
  std::vector<std::string> names;
  for (const Phalanx& phalanx : phalanges) {
    names.push_back("body." + phalanx.body + ".mass");
  }
  return names;
}

/// weight · mass of the phalanges in kg.
TermPointer mass_term(const ParameterSet& set, const std::array<Phalanx, 3>& phalanges,
                      double weight) {
  std::vector<ValuePlace> places;
  for (const std::string& name : weighed_bodies(phalanges)) {
    places.push_back({ValueField::kP, 0, set.find(name)});
  }
  return weighted_numbers("mass", std::move(places), Eigen::Vector3d::Constant(weight));
}

}  // namespace

Reach make_reach(const std::filesystem::path& scene_file, const ReachOptions& options) {
  const int steps = options.steps;
  if (steps < 12 || steps % (steps < 60 ? 12 : 60) != 0) {
    throw InvalidInput(
        concat("finger: ", steps, " steps; expected a multiple of 60, or 12, 24, 36 or 48"));
  }
  const scene::Scene scene = scene::read_scene(scene_file);
  const Model model = scene::build_model(scene);
  require_finger(model);
  const std::string tip = model.end_effectors().front().name;
  const double tip_mass = model.link(model.end_effectors().front().link).body.mass;
  ParameterSet set = finger_parameters(model, options.payload.has_value());

  Reach out{phalanges(model), {}, nullptr};
  out.targets = {{steps / 4, {0.185, 0.125, -0.100}},
                 {steps / 2, {0.090, 0.020, -0.175}},
                 {3 * steps / 4, {0.235, -0.130, -0.040}},
                 {steps, {0.170, -0.035, -0.175}}};
  std::vector<ConstraintPointer> constraints;
  for (const Target& target : out.targets) {
    constraints.push_back(variable_at_step(model, tip, target.step, target.position, kHalfWidth));
  }
  std::vector<int> sampled;
  const int stride = std::max(1, steps / kLimitSamples);
  for (int k = stride; k <= steps; k += stride) {
    sampled.push_back(k);
  }
  constraints.push_back(joint_limits(model, sampled, kLimitMargin));
  constraints.push_back(parameter_sum(set, "total mass", weighed_bodies(out.phalanges),
                                      -std::numeric_limits<double>::infinity(),
                                      kMassLimit - tip_mass));
  constraints.push_back(slenderness(out.phalanges, set, kRatio));

  HeldControls controls;
  controls.hold = std::max(1, steps / options.blocks);
  controls.start = holding_controls(model, kStart);
  controls.lower = Eigen::VectorXd::Constant(4, -1.0);
  controls.upper = Eigen::VectorXd::Constant(4, 1.0);
  const DesignMapPointer map = finger_map(out.phalanges, set, options.payload);
  SimulationOptions simulation;
  simulation.integrator = "bdf2";
  simulation.h = kDuration / steps;
  simulation.steps = steps;
  simulation.restarts = segment_starts(steps, options.segments);
  Objective objective(effort(options.effort_weight));
  if (options.mass_weight != 0.0) {
    objective.add(mass_term(set, out.phalanges, 10.0 * options.mass_weight));
  }
  out.problem = transcribe(TrajectoryProblem{.horizon = Horizon(model, std::move(set), simulation),
                                             .map = map,
                                             .objective = std::move(objective),
                                             .constraints = std::move(constraints),
                                             .controls = std::move(controls),
                                             .q0 = kStart,
                                             .qdot0 = {}},
                           options.transcription);
  return out;
}

solvers::IpoptOptions ipopt_options(int max_iterations) {
  solvers::IpoptOptions options;
  options.tolerance = 1e-6;
  options.acceptable_tolerance = 1e-5;
  options.max_iterations = max_iterations;
  options.integer_options["limited_memory_max_history"] = 20;
  return options;
}

Eigen::VectorXd tip_errors(const Reach& reach, const TrajectoryValues& values) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(reach.targets.size()));
  for (std::size_t i = 0; i < reach.targets.size(); ++i) {
    const Target& target = reach.targets[i];
    out[static_cast<Eigen::Index>(i)] = (values.v().col(target.step) - target.position).norm();
  }
  return out;
}

}  // namespace hbar::finger_reach
