#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar {

ValueReader::ValueReader(const Model& model, const std::vector<Measurement>& measurements)
    : model_(model),
      mechanism_(nominal_mechanism<double>(model)),
      motion_(model.tree()),
      outputs_(model, measurements),
      rows_(outputs_.zero_rows()),
      contacts_(model),
      none_(Eigen::VectorXd::Zero(model.dof())) {}

TrajectoryValues ValueReader::values(const ParameterSet& set, const Trajectory& trajectory,
                                     double h) {
  const int steps = trajectory.step_count();
  TrajectoryValues out;
  out.h = h;
  out.q.resize(model_.dof(), steps + 1);
  out.qdot.resize(model_.dof(), steps + 1);
  out.v.resize(model_.variable_count(), steps + 1);
  out.tactile.resize(model_.tactile_count(), steps + 1);
  out.measured.resize(rows_.measured.size(), steps + 1);
  out.u = trajectory.inputs.u.leftCols(steps);
  out.p = trajectory.inputs.p;
  apply_parameters<double>(model_, set, trajectory.inputs.p, mechanism_);
  for (int k = 0; k <= steps; ++k) {
    out.q.col(k) = trajectory.q_at_step(k);
    out.qdot.col(k) = trajectory.qdot_at_step(k);
    if (!outputs_.empty()) {
      outputs_.read(mechanism_, outputs_.motion_at(mechanism_, out.q.col(k), out.qdot.col(k)),
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
    const ParameterSet& set, const Trajectory& trajectory) {
  apply_parameters<double>(model_, set, trajectory.inputs.p, mechanism_);
  std::vector<std::vector<ContactSummary>> out;
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    compute_motion<double>(model_.tree(), mechanism_, trajectory.q_at_step(k),
                           trajectory.qdot_at_step(k), none_, motion_);
    contacts_.evaluate(mechanism_, motion_);
    out.emplace_back();
    for (int i = 0; i < model_.contact_count(); ++i) {
      out.back().push_back(contacts_.summary(i));
    }
  }
  return out;
}

}  // namespace hbar
