#include "hbar/adjoint/trajectory/value_reader.h"

#include <utility>

namespace hbar {

ValueReader::ValueReader(Horizon horizon)
    : horizon_(std::move(horizon)),
      motion_(horizon_.model().tree()),
      outputs_(horizon_.model(), horizon_.options().measurements),
      rows_(outputs_.zero_rows()),
      contacts_(horizon_.model()),
      none_(Eigen::VectorXd::Zero(horizon_.model().dof())) {}

TrajectoryValues ValueReader::values(const Trajectory& trajectory) {
  const Model& model = horizon_.model();
  const int steps = trajectory.step_count();
  TrajectoryValues out;
  out.h = horizon_.options().h;
  out.q.resize(model.dof(), steps + 1);
  out.qdot.resize(model.dof(), steps + 1);
  out.v.resize(model.variable_count(), steps + 1);
  out.tactile.resize(model.tactile_count(), steps + 1);
  out.measured.resize(rows_.measured.size(), steps + 1);
  out.u = trajectory.inputs.u.leftCols(steps);
  out.p = trajectory.inputs.p;
  for (int k = 0; k <= steps; ++k) {
    out.q.col(k) = trajectory.q_at_step(k);
    out.qdot.col(k) = trajectory.qdot_at_step(k);
    if (!outputs_.empty()) {
      outputs_.read(*trajectory.mechanism,
                    outputs_.motion_at(*trajectory.mechanism, out.q.col(k), out.qdot.col(k)),
                    out.q.col(k), out.qdot.col(k), trajectory.inputs.u.col(measured_step(k)),
                    rows_);
      out.v.col(k) = rows_.v;
      out.tactile.col(k) = rows_.tactile;
      out.measured.col(k) = rows_.measured;
    }
  }
  return out;
}

std::vector<std::vector<ContactSummary>> ValueReader::contact_history(
    const Trajectory& trajectory) {
  const Model& model = horizon_.model();
  std::vector<std::vector<ContactSummary>> out;
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    compute_motion<double>(model.tree(), *trajectory.mechanism, trajectory.q_at_step(k),
                           trajectory.qdot_at_step(k), none_, motion_);
    contacts_.evaluate(*trajectory.mechanism, motion_);
    out.emplace_back();
    for (int i = 0; i < model.contact_count(); ++i) {
      out.back().push_back(contacts_.summary(i));
    }
  }
  return out;
}

TrajectoryValues read_values(const Horizon& horizon, const Trajectory& trajectory) {
  return ValueReader(horizon).values(trajectory);
}

std::vector<std::vector<ContactSummary>> contact_history(const Horizon& horizon,
                                                         const Trajectory& trajectory) {
  return ValueReader(horizon).contact_history(trajectory);
}

}  // namespace hbar
