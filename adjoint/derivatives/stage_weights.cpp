#include "hbar/adjoint/derivatives/stage_weights.h"

#include "hbar/adjoint/outputs/instant_outputs.h"
#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

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

StageWeights stage_weights(const Horizon& horizon, const Trajectory& trajectory,
                           const TrajectoryPartials& partials) {
  const Model& model = horizon.model();
  StageWeights out{Eigen::MatrixXd::Zero(model.dof(), trajectory.timeline.stage_count()),
                   Eigen::VectorXd::Zero(model.dof()), partials.p, partials.u};
  const Mechanism<double>& mechanism = *trajectory.mechanism;
  InstantOutputs<double> outputs(model, horizon.options().measurements);
  Eigen::VectorXd by_rate(model.dof());
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q_bar.col(s) += partials.q.col(k);
    by_rate = partials.qdot.col(k);
    if (!outputs.empty()) {
      const auto q = trajectory.q.col(s);
      const auto qdot = trajectory.qdot.col(s);
      const int step = measured_step(k);
      outputs.pull_back(mechanism, horizon.parameters(), trajectory.inputs.p,
                        outputs.motion_at(mechanism, q, qdot), q, qdot,
                        trajectory.inputs.u.col(step),
                        {partials.v.col(k), partials.tactile.col(k), partials.measured.col(k)},
                        out.q_bar.col(s), by_rate, out.u.col(step), out.p);
    }
    add_rate_weights(model, trajectory, s, by_rate, out);
  }
  return out;
}

}  // namespace hbar
