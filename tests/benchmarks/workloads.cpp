#include "tests/benchmarks/workloads.h"

#include <algorithm>
#include <cmath>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/random.h"

namespace hbar::benchmarks {
namespace {

using testing::Random;

SimulationOptions simulation_options(const std::string& integrator, bool keep_factors) {
  SimulationOptions options;
  options.integrator = integrator;
  options.h = kStep;
  options.steps = kSteps;
  options.keep_factors = keep_factors;
  return options;
}

ParameterSet first_parameters(const Model& model, int count) {
  const ParameterSet all = ParameterSet::all(model);
  std::vector<std::string> names;
  for (int i = 0; i < std::min(count, all.size()); ++i) {
    names.push_back(all[i].name);
  }
  return ParameterSet::named(model, names);
}

}  // namespace

StageWork::StageWork(const HingeModel& hinges)
    : model_(build_model(hinges)),
      mujoco_(hinges, kStep),
      mechanism_(nominal_mechanism<double>(model_)),
      stage_(model_),
      points_(kPoints, StagePoint<double>(model_)),
      g_(model_.dof()),
      G_q_(model_.dof(), model_.dof()),
      G_v_(model_.dof(), model_.dof()),
      M_(model_.dof(), model_.dof()) {
  Random random(1);
  for (StagePoint<double>& point : points_) {
    point.q = random.vector(model_.dof(), 0.8);
    point.qdot = random.vector(model_.dof(), 1.0);
    point.a = random.vector(model_.dof(), 10.0);
    point.u = random.vector(model_.control_count(), 0.01);
    point.start = {point.q, point.qdot};
    point.rate = 1.0 / kStep;
    const double gap = mujoco_.gap(model_, point.q, point.qdot);
    if (!(gap < 1e-9)) {
      throw NumericalFailure(concat(hinges.name, ": hbar and MuJoCo differ by ", gap));
    }
  }
}

const StagePoint<double>& StageWork::next() {
  at_ = (at_ + 1) % kPoints;
  return points_[at_];
}

void StageWork::residual() { stage_.residual(mechanism_, next(), g_); }

void StageWork::jacobian_blocks() {
  stage_.linearize(mechanism_, next(), g_);
  stage_.jacobian({1.0, 0.0, 0.0}, G_q_);
  stage_.jacobian({0.0, 1.0, 0.0}, G_v_);
  stage_.jacobian({0.0, 0.0, 1.0}, M_);
}

void StageWork::newton_matrix() {
  stage_.linearize(mechanism_, next(), g_);
  stage_.newton_matrix(G_q_);
}

void StageWork::mujoco_step() {
  const StagePoint<double>& point = next();
  mujoco_.set(point.q, point.qdot, point.u);
  mujoco_.step();
}

RolloutWork::RolloutWork(const HingeModel& hinges, const std::string& integrator, int parameters)
    : RolloutWork(hinges, build_model(hinges), integrator, parameters) {}

RolloutWork::RolloutWork(const HingeModel& hinges, const Model& model,
                         const std::string& integrator, int parameters)
    : mujoco_(hinges, kStep),
      horizon_(model, first_parameters(model, parameters), simulation_options(integrator, true)),
      simulator_(horizon_),
      bare_(horizon_.with(simulation_options(integrator, false))),
      inputs_(horizon_.nominal_inputs()),
      adjoint_(horizon_),
      objective_(squared_variables()) {
  Random random(2);
  // Chains of any length are bent alike at the tip: angles add up as a random walk.
  const double spread = 1.6 / std::sqrt(static_cast<double>(model.dof()));
  inputs_.q0 = random.vector(model.dof(), spread);
  inputs_.qdot0 = random.vector(model.dof(), spread);
  for (int k = 0; k < kSteps; ++k) {
    inputs_.u.col(k) = random.vector(model.control_count(), 0.005);
  }
  forward();
}

void RolloutWork::forward() { trajectory_ = simulator_.rollout(inputs_).trajectory(); }

void RolloutWork::forward_alone() {
  const Rollout rollout = bare_.rollout(inputs_);
  if (!rollout.converged()) {
    throw NumericalFailure(rollout.report().message);
  }
}

void RolloutWork::sweep() {
  const Gradient gradient = adjoint_.gradient(trajectory_, objective_);
  if (!gradient.q0.allFinite()) {
    throw NumericalFailure("gradient not finite");
  }
}

void RolloutWork::forward_and_sweep() {
  forward();
  sweep();
}

void RolloutWork::mujoco_rollout() {
  mujoco_.set(inputs_.q0, inputs_.qdot0, inputs_.u.col(0));
  for (int k = 0; k < kSteps; ++k) {
    mujoco_.set_control(inputs_.u.col(k));
    mujoco_.step();
  }
}

void RolloutWork::mujoco_rollout_with_A_B() {
  mujoco_.set(inputs_.q0, inputs_.qdot0, inputs_.u.col(0));
  for (int k = 0; k < kSteps; ++k) {
    mujoco_.set_control(inputs_.u.col(k));
    mujoco_.transition_differences();
    mujoco_.step();
  }
}

int newton_iterations(const Trajectory& trajectory) {
  int sum = 0;
  for (const solvers::NewtonReport& report : trajectory.newton) {
    sum += report.iterations;
  }
  return sum;
}

int factorizations(const Trajectory& trajectory) {
  int sum = 0;
  for (const solvers::NewtonReport& report : trajectory.newton) {
    sum += report.factorizations;
  }
  return sum;
}

int RolloutWork::newton_iterations() const { return benchmarks::newton_iterations(trajectory_); }

int RolloutWork::factorizations() const { return benchmarks::factorizations(trajectory_); }

}  // namespace hbar::benchmarks
