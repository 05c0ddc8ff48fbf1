#include "hbar/adjoint/derivatives/stage_weights.h"

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/check_trajectory.h"
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
  require_whole_trajectory_of(horizon, trajectory);
  const Model& model = horizon.model();
  StageWeights out{Eigen::MatrixXd::Zero(model.dof(), trajectory.timeline.stage_count()),
                   Eigen::VectorXd::Zero(model.dof()), partials.p, partials.u};
  const Applied<double> applied{*trajectory.mechanism, horizon.parameters(), trajectory.inputs.p};
  Measurements<double> measurements(model, horizon.measurements());
  InstantMotion<double> instants(model, measurements.reads_contacts());
  Eigen::VectorXd by_rate(model.dof());
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q_bar.col(s) += partials.q.col(k);
    by_rate = partials.qdot.col(k);
    if (!measurements.empty()) {
      const int step = measured_step(k);
      const Instant<double> at = instants.at(applied, trajectory.q.col(s), trajectory.qdot.col(s),
                                             trajectory.inputs.u.col(step));
      InstantGradient<double> by{out.q_bar.col(s), by_rate, out.u.col(step), out.p};
      measurements.linearize(at);
      measurements.pull_back(at, partials.measured.col(k), by);
    }
    add_rate_weights(model, trajectory, s, by_rate, out);
  }
  return out;
}

}  // namespace hbar
