#include "hbar/adjoint/trajectory/value_reader.h"

#include <utility>

#include "hbar/adjoint/trajectory/check_trajectory.h"

namespace hbar {

ValueReader::ValueReader(Horizon horizon)
    : horizon_(std::move(horizon)),
      measurements_(horizon_.model(), horizon_.measurements()),
      instants_(horizon_.model(), measurements_.reads_contacts()),
      motion_(horizon_.model().tree()),
      contacts_(horizon_.model()),
      none_(Eigen::VectorXd::Zero(horizon_.model().dof())) {}

TrajectoryValues ValueReader::values(const Trajectory& trajectory) {
  require_trajectory_of(horizon_, trajectory);
  const int steps = trajectory.step_count();
  TrajectoryValues out;
  out.h = horizon_.options().h;
  out.q.resize(horizon_.model().dof(), steps + 1);
  out.qdot.resize(horizon_.model().dof(), steps + 1);
  out.measured.resize(measurements_.size(), steps + 1);
  out.measured_rows = horizon_.measured_rows();
  out.u = trajectory.inputs.u.leftCols(steps);
  out.p = trajectory.inputs.p;
  const Applied<double> applied{*trajectory.mechanism, horizon_.parameters(), trajectory.inputs.p};
  for (int k = 0; k <= steps; ++k) {
    out.q.col(k) = trajectory.q_at_step(k);
    out.qdot.col(k) = trajectory.qdot_at_step(k);
    if (!measurements_.empty()) {
      const Instant<double> at = instants_.at(applied, out.q.col(k), out.qdot.col(k),
                                              trajectory.inputs.u.col(measured_step(k)));
      measurements_.linearize(at);
      measurements_.read(at, out.measured.col(k));
    }
  }
  return out;
}

std::vector<std::vector<ContactSummary>> ValueReader::contact_history(
    const Trajectory& trajectory) {
  require_trajectory_of(horizon_, trajectory);
  std::vector<std::vector<ContactSummary>> out;
  out.reserve(static_cast<std::size_t>(trajectory.step_count()) + 1);
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    out.push_back(
        contacts_at(*trajectory.mechanism, trajectory.q_at_step(k), trajectory.qdot_at_step(k)));
  }
  return out;
}

std::vector<ContactSummary> ValueReader::contacts_at_start(const Inputs& inputs) {
  horizon_.check(inputs);
  return contacts_at(*horizon_.mechanism(inputs.p), inputs.q0, inputs.qdot0);
}

std::vector<ContactSummary> ValueReader::contacts_at(const Mechanism<double>& mechanism,
                                                     const Eigen::VectorXd& q,
                                                     const Eigen::VectorXd& qdot) {
  const Model& model = horizon_.model();
  compute_motion<double>(model.tree(), mechanism, q, qdot, none_, motion_);
  contacts_.evaluate(mechanism, motion_);
  std::vector<ContactSummary> out;
  out.reserve(static_cast<std::size_t>(model.contact_count()));
  for (int i = 0; i < model.contact_count(); ++i) {
    out.push_back(contacts_.summary(i));
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

TrajectoryValues value_shape(const Horizon& horizon) {
  const int steps = horizon.steps();
  TrajectoryValues out;
  out.h = horizon.options().h;
  out.q.setZero(horizon.model().dof(), steps + 1);
  out.qdot.setZero(horizon.model().dof(), steps + 1);
  out.measured.setZero(horizon.measured_count(), steps + 1);
  out.measured_rows = horizon.measured_rows();
  out.u.setZero(horizon.model().control_count(), steps);
  out.p.setZero(horizon.parameters().size());
  return out;
}

}  // namespace hbar
