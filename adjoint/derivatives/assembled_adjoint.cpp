#include "hbar/adjoint/derivatives/assembled_adjoint.h"

#include <utility>

#include "hbar/adjoint/derivatives/stage_weights.h"
#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar {

AssembledAdjoint::AssembledAdjoint(const Horizon& horizon, solvers::SolverFactory factory)
    : horizon_(horizon), reader_(horizon), system_(horizon, std::move(factory)) {}

Gradient AssembledAdjoint::pull_back(const Trajectory& trajectory,
                                     const TrajectoryPartials& partials) {
  const StageWeights weights = stage_weights(horizon_, trajectory, partials);
  const Eigen::Index stages = weights.q_bar.cols() - 1;
  const Linearization& system = system_.update(trajectory);
  const Eigen::VectorXd y_bar = weights.q_bar.rightCols(stages).reshaped();
  z_bar_.resize(y_bar.size());
  system_.solver().solve_transposed(y_bar, z_bar_);
  Gradient out;
  out.p = weights.p - system.dg_dp.transpose() * z_bar_;
  out.u = weights.u;
  out.u.reshaped() -= system.dg_du.transpose() * z_bar_;
  out.q0 = weights.q_bar.col(0) - system.dg_dq0.matrix().transpose() * z_bar_;
  out.qdot0 = weights.qdot0 - system.dg_dqdot0.matrix().transpose() * z_bar_;
  return out;
}

Gradient AssembledAdjoint::gradient(const Trajectory& trajectory, const Objective& objective) {
  const TrajectoryValues values = reader_.values(trajectory);
  Gradient out = pull_back(trajectory, objective.partials(values));
  out.value = objective.value(values);
  return out;
}

Gradient gradient(const Horizon& horizon, const Trajectory& trajectory, const Objective& objective,
                  const solvers::SolverFactory& factory) {
  return AssembledAdjoint(horizon, factory).gradient(trajectory, objective);
}

}  // namespace hbar
