// How the numbers that terms read depend on the variables of AllAtOnce.
#include <algorithm>

#include "hbar/adjoint/all_at_once.h"

namespace hbar {

/// Whether an output's row may change with a coordinate at its instant.
bool AllAtOnce::depends(const ValuePlace& place, int coordinate) const {
  if (place.field != ValueField::kV) {
    return true;
  }
  const std::vector<int>& path = paths_[static_cast<std::size_t>(place.index / 3)];
  return std::binary_search(path.begin(), path.end(), coordinate);
}

std::vector<Eigen::Index> AllAtOnce::columns_of(const ValuePlace& place) const {
  std::vector<Eigen::Index> out;
  if (place.field == ValueField::kU) {
    return {head_.control_place(head_.block_of_step(place.step)) + place.index};
  }
  if (place.field == ValueField::kP) {
    return head_.designs_of(place.index);
  }
  const int stage = trajectory_.timeline.step_end(place.step);
  const std::vector<StageEntry>& entries = stages_[static_cast<std::size_t>(stage)];
  if (place.field == ValueField::kQ || place.field == ValueField::kQdot) {
    for (const StageEntry& entry : entries) {
      if ((place.field == ValueField::kQ ? entry.q : entry.qdot) != 0.0) {
        out.push_back(entry.place + place.index);
      }
    }
    return out;
  }
  for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
    out.push_back(i);
  }
  if (place.field == ValueField::kMeasured) {
    const int block = head_.block_of_step(measured_step(place.step));
    for (Eigen::Index i = 0; i < head_.control_count(); ++i) {
      out.push_back(head_.control_place(block) + i);
    }
  }
  for (const StageEntry& entry : entries) {
    if (entry.q != 0.0 || (place.field != ValueField::kV && entry.qdot != 0.0)) {
      for (int c = 0; c < problem_.simulator.model().dof(); ++c) {
        if (depends(place, c)) {
          out.push_back(entry.place + c);
        }
      }
    }
  }
  return out;
}

/// by_q_, by_qdot_, by_u_ and by_p_ of one output row.
void AllAtOnce::differentiate_output(const ValuePlace& place) {
  const int stage = trajectory_.timeline.step_end(place.step);
  OutputRows<double> y = outputs_.zero_rows();
  switch (place.field) {
    case ValueField::kV:
      y.v[place.index] = 1.0;
      break;
    case ValueField::kTactile:
      y.tactile[place.index] = 1.0;
      break;
    default:
      y.measured[place.index] = 1.0;
      break;
  }
  by_q_.setZero(trajectory_.q.rows());
  by_qdot_.setZero(trajectory_.q.rows());
  by_u_.setZero(head_.control_count());
  by_p_.setZero(trajectory_.inputs.p.size());
  const auto q = trajectory_.q.col(stage);
  const auto qdot = trajectory_.qdot.col(stage);
  outputs_.pull_back(mechanism_, problem_.simulator.parameters(), trajectory_.inputs.p,
                     outputs_.motion_at(mechanism_, q, qdot), q, qdot,
                     trajectory_.inputs.u.col(measured_step(place.step)), y, by_q_, by_qdot_, by_u_,
                     by_p_);
}

void AllAtOnce::derivatives_of(const ValuePlace& place, std::vector<double>& out) {
  out.clear();
  if (place.field == ValueField::kU) {
    out.push_back(1.0);
    return;
  }
  if (place.field == ValueField::kP) {
    for (const Eigen::Index i : head_.designs_of(place.index)) {
      out.push_back(map_jacobian_(place.index, i));
    }
    return;
  }
  const int stage = trajectory_.timeline.step_end(place.step);
  const std::vector<StageEntry>& entries = stages_[static_cast<std::size_t>(stage)];
  if (place.field == ValueField::kQ || place.field == ValueField::kQdot) {
    for (const StageEntry& entry : entries) {
      const double weight = place.field == ValueField::kQ ? entry.q : entry.qdot;
      if (weight != 0.0) {
        out.push_back(weight);
      }
    }
    return;
  }
  differentiate_output(place);
  const Eigen::VectorXd by_d = map_jacobian_.transpose() * by_p_;
  out.assign(by_d.begin(), by_d.end());
  if (place.field == ValueField::kMeasured) {
    out.insert(out.end(), by_u_.begin(), by_u_.end());
  }
  for (const StageEntry& entry : entries) {
    if (entry.q != 0.0 || (place.field != ValueField::kV && entry.qdot != 0.0)) {
      for (int c = 0; c < problem_.simulator.model().dof(); ++c) {
        if (depends(place, c)) {
          out.push_back(entry.q * by_q_[c] + entry.qdot * by_qdot_[c]);
        }
      }
    }
  }
}

}  // namespace hbar
