#include "task.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::manipulation {
namespace {

int coordinate_index(const Model& model, const std::string& name) {
  for (int i = 0; i < model.dof(); ++i) {
    if (model.coordinate_name(i) == name) {
      return i;
    }
  }
  throw InvalidInput(concat("the scene has no coordinate '", name, "'"));
}

/// The first guess, block by block.                                        [controls x blocks]
Eigen::MatrixXd guessed_controls(const Task& task, int controls) {
  const int blocks = (task.steps + task.hold - 1) / task.hold;
  Eigen::MatrixXd out(controls, blocks);
  for (int b = 0; b < blocks; ++b) {
    const double share = (b + 1.0) / blocks;
    std::size_t next = 0;
    while (next + 1 < task.guess.size() && task.guess[next].share < share) {
      ++next;
    }
    const WayPoint& after = task.guess[next];
    const WayPoint& before = task.guess[next == 0 ? 0 : next - 1];
    const double span = after.share - before.share;
    const double w = span > 0.0 ? std::min(1.0, (share - before.share) / span) : 1.0;
    out.col(b) = (1.0 - w) * before.controls + w * after.controls;
  }
  return out;
}

/// ½ Σ_k ‖(u_k − u_{k−1}) / scale‖²: what held positions have to move. Only where one block of
/// controls follows another can they change.
TermPointer control_changes(const Task& task) {
  std::vector<std::vector<ValuePlace>> pairs;
  std::vector<double> weights;
  for (int k = task.hold; k < task.steps; k += task.hold) {
    for (int i = 0; i < static_cast<int>(task.control_scale.size()); ++i) {
      pairs.push_back({{ValueField::kU, k - 1, i}, {ValueField::kU, k, i}});
      weights.push_back(1.0 / (task.control_scale[i] * task.control_scale[i]));
    }
  }
  const auto half_square = [](auto u) { return 0.5 * (u[1] - u[0]) * (u[1] - u[0]); };
  return generic_sum(
      "changes of controls", std::move(pairs), half_square,
      Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size())));
}

/// ½ Σ weight ∫ (q − path)² dt of the goals, where the path rises smoothly from the start to the
/// target and stays there for the last part of the time.
TermPointer goal_paths(const Task& task, const Model& model, const Eigen::VectorXd& q0) {
  std::vector<StepSum> sums;
  for (const Goal& goal : task.goals) {
    const int index = coordinate_index(model, goal.coordinate);
    Eigen::MatrixXd path(1, task.steps);
    for (int k = 1; k <= task.steps; ++k) {
      const double share = std::clamp((static_cast<double>(k) / task.steps - task.path_begin) /
                                          (task.path_end - task.path_begin),
                                      0.0, 1.0);
      const double rise = share * share * (3.0 - 2.0 * share);
      path(0, k - 1) = q0[index] + rise * (goal.target - q0[index]);
    }
    sums.push_back({.field = ValueField::kQ,
                    .rows = {index},
                    .target = std::move(path),
                    .weight = goal.weight,
                    .times_h = true});
  }
  return separable_term("paths to the goals", std::move(sums), [](double miss) {
    return Jet{0.5 * miss * miss, miss, 1.0};
  });
}

std::string contact_scale_of(const std::string& body) { return "body." + body + ".contact_scale"; }

}  // namespace

std::unique_ptr<Transcription> make_problem(const Task& task, double contact_scale,
                                            const Eigen::VectorXd& start) {
  const scene::Scene scene = scene::read_scene(task.scene);
  const Model model = scene::build_model(scene);
  std::vector<std::string> names = example::stretched_parameters(model, task.lengths);
  std::transform(task.scaled_bodies.begin(), task.scaled_bodies.end(), std::back_inserter(names),
                 contact_scale_of);
  const ParameterSet set = ParameterSet::named(model, names);
  Eigen::VectorXd base = set.nominal();
  for (const std::string& body : task.scaled_bodies) {
    base[set.find(contact_scale_of(body))] = contact_scale;
  }
  HeldControls controls;
  controls.hold = task.hold;
  controls.start = guessed_controls(task, model.control_count());
  controls.lower = -task.control_bound;
  controls.upper = task.control_bound;
  controls.scale = task.control_scale;
  Eigen::VectorXd lengths;
  if (start.size() > 0) {
    lengths = start.head(static_cast<Eigen::Index>(task.lengths.size()));
    controls.start = start.tail(start.size() - lengths.size())
                         .reshaped(controls.start.rows(), controls.start.cols());
  }
  SimulationOptions simulation;
  simulation.integrator = "bdf1";
  simulation.h = task.duration / task.steps;
  simulation.steps = task.steps;
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(model.dof());
  for (const auto& [name, value] : task.start) {
    q0[coordinate_index(model, name)] = value;
  }
  Objective objective(control_changes(task));
  objective.add(goal_paths(task, model, q0));
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.dof());
  objective.add(squared_velocity(task.velocity_weight))
      .add(terminal_state(rest, rest, 0.0, task.rest_weight));
  return transcribe(TrajectoryProblem{
      .horizon = Horizon(model, set, simulation),
      .map = example::stretch_map(model, set, base, task.lengths, task.length_share, lengths),
      .objective = std::move(objective),
      .constraints = {},
      .controls = std::move(controls),
      .q0 = q0,
      .qdot0 = {},
      .design_weight = 1e-2});
}

Eigen::VectorXd goal_errors(const Task& task, const Model& model, const TrajectoryValues& values) {
  Eigen::VectorXd errors(static_cast<Eigen::Index>(task.goals.size()));
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const Goal& goal = task.goals[static_cast<std::size_t>(i)];
    const int coordinate = coordinate_index(model, goal.coordinate);
    errors[i] = std::abs(values.q(coordinate, values.q.cols() - 1) - goal.target);
  }
  return errors;
}

}  // namespace hbar::manipulation
