#include "hbar/adjoint/assembled_adjoint.h"

#include <utility>

#include "hbar/solvers/block_substitution.h"

namespace hbar {
namespace {

/// ∂Ψ/∂q̄ with rates and variables replaced by what they depend on, per stage (column 0 is q₀), and
/// the direct shares of q̇₀ and p.
struct StageWeights {
  Eigen::MatrixXd q_bar;  // [dof x stages]
  Eigen::VectorXd qdot0;  // [dof]
  Eigen::VectorXd p;      // [parameters]
};

/// Adds (∂q̇_s/∂q̄)ᵀ y to the stages that q̇_s looks back on.
void add_rate_weights(const Model& model, const Trajectory& trajectory, int s,
                      const Eigen::VectorXd& y, StageWeights& out) {
  if (s == 0) {
    out.qdot0 += y;
    return;
  }
  Eigen::VectorXd plain = y;
  for (const int node : nodes_with_chart_switch(trajectory, s)) {
    const int first = model.tree().node(node).coordinates.begin;
    for (const auto& entry : flat_stencil(model, trajectory, s, node).entries) {
      out.q_bar.col(entry.stage).segment<3>(first) += entry.qdot.transpose() * y.segment<3>(first);
    }
    plain.segment<3>(first).setZero();
  }
  for (const auto& entry : flat_stencil(trajectory.timeline, s).entries) {
    out.q_bar.col(entry.stage) += entry.qdot * plain;
  }
}

StageWeights stage_weights(Simulator& simulator, const Trajectory& trajectory,
                           const TrajectoryPartials& partials) {
  const Model& model = simulator.model();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(model.dof());
  StageWeights out{Eigen::MatrixXd::Zero(model.dof(), trajectory.timeline.stage_count()), none,
                   partials.p};
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  apply_parameters<double>(model, simulator.parameters(), trajectory.inputs.p, mechanism);
  Motion<double> motion(model.tree());
  EndEffectors<double> end_effectors(model);
  TactileReadings<double> tactile(model);
  Eigen::VectorXd by_rate(model.dof());
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q_bar.col(s) += partials.q.col(k);
    by_rate = partials.qdot.col(k);
    if (model.variable_count() + model.tactile_count() > 0) {
      compute_motion<double>(model.tree(), mechanism, trajectory.q.col(s), trajectory.qdot.col(s),
                             none, motion);
      end_effectors.pull_back(mechanism, simulator.parameters(), trajectory.inputs.p, motion,
                              partials.v.col(k), out.q_bar.col(s), out.p);
      tactile.pull_back(mechanism, simulator.parameters(), trajectory.inputs.p, motion,
                        partials.tactile.col(k), out.q_bar.col(s), by_rate, out.p);
    }
    add_rate_weights(model, trajectory, s, by_rate, out);
  }
  return out;
}

}  // namespace

AssembledAdjoint::AssembledAdjoint(Simulator& simulator,
                                   std::unique_ptr<solvers::LinearSolver> solver)
    : simulator_(simulator),
      linearizer_(simulator),
      solver_(std::move(solver)),
      owns_block_solver_(solver_ == nullptr) {}

void AssembledAdjoint::solve(const Trajectory& trajectory, const Eigen::VectorXd& y_bar) {
  linearization_ = &linearizer_.linearize(trajectory);
  const solvers::SparseMatrix& H = linearization_->H.matrix();
  if (analyzed_pattern_ != linearizer_.pattern_count()) {
    if (owns_block_solver_) {
      solver_ = solvers::make_block_substitution(linearization_->block_sizes);
    }
    solver_->analyze(H);
    analyzed_pattern_ = linearizer_.pattern_count();
  }
  solver_->factorize(H);
  Eigen::MatrixXd z(y_bar.size(), 1);
  solver_->solve_transposed(y_bar, z);
  z_bar_ = z.col(0);
}

Gradient AssembledAdjoint::pull_back(const Trajectory& trajectory,
                                     const TrajectoryPartials& partials) {
  const StageWeights weights = stage_weights(simulator_, trajectory, partials);
  const Eigen::Index stages = weights.q_bar.cols() - 1;
  solve(trajectory, weights.q_bar.rightCols(stages).reshaped());
  const Linearization& system = *linearization_;
  Gradient out;
  out.p = weights.p - system.dg_dp.transpose() * z_bar_;
  out.u = partials.u;
  out.u.reshaped() -= system.dg_du.transpose() * z_bar_;
  out.q0 = weights.q_bar.col(0) - system.dg_dq0.matrix().transpose() * z_bar_;
  out.qdot0 = weights.qdot0 - system.dg_dqdot0.matrix().transpose() * z_bar_;
  return out;
}

Gradient AssembledAdjoint::gradient(const Trajectory& trajectory, const Objective& objective) {
  const TrajectoryValues values = simulator_.values(trajectory);
  Gradient out = pull_back(trajectory, objective.partials(values));
  out.value = objective.value(values);
  return out;
}

}  // namespace hbar
