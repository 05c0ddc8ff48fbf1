#include "hbar/adjoint/programs/value_dependence.h"

#include <algorithm>

namespace hbar {
namespace {

bool holds(const std::vector<int>& coordinates, int c) {
  return std::binary_search(coordinates.begin(), coordinates.end(), c);
}

}  // namespace

ValueDependence::ValueDependence(const Horizon& horizon, const InputVariables& head,
                                 const StageLayout& layout)
    : horizon_(horizon),
      head_(head),
      layout_(layout),
      measurements_(horizon.model(), horizon.measurements()),
      instants_(horizon.model(), measurements_.reads_contacts()),
      steps_(static_cast<std::size_t>(horizon.steps()) + 1),
      weights_(Eigen::VectorXd::Zero(measurements_.size())) {
  for (const Measurement& measurement : horizon.measurements()) {
    const std::vector<MeasuredReads> rows = measured_reads(horizon.model(), measurement);
    reads_.insert(reads_.end(), rows.begin(), rows.end());
  }
}

/// Whether a row can depend on a coordinate of a run of x.
bool ValueDependence::depends(const MeasuredReads& reads, const StageRun& run, int coordinate) {
  return (run.q != 0.0 && holds(reads.q, coordinate)) ||
         (run.qdot != 0.0 && holds(reads.qdot, coordinate));
}

std::vector<Eigen::Index> ValueDependence::columns_of(const ValuePlace& place) const {
  std::vector<Eigen::Index> out;
  if (place.field == ValueField::kU) {
    return {head_.control_place(head_.block_of_step(place.step)) + place.index};
  }
  if (place.field == ValueField::kP) {
    return head_.designs_of(place.index);
  }
  const std::vector<StageRun>& runs = layout_.runs(layout_.stage_of_step(place.step));
  if (place.field != ValueField::kMeasured) {
    for (const StageRun& run : runs) {
      if ((place.field == ValueField::kQ ? run.q : run.qdot) != 0.0) {
        out.push_back(run.place + place.index);
      }
    }
    return out;
  }
  for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
    out.push_back(i);
  }
  const int block = head_.block_of_step(measured_step(place.step));
  for (const int control : reads(place.index).controls) {
    out.push_back(head_.control_place(block) + control);
  }
  for (const StageRun& run : runs) {
    for (int c = 0; c < layout_.dof(); ++c) {
      if (depends(reads(place.index), run, c)) {
        out.push_back(run.place + c);
      }
    }
  }
  return out;
}

void ValueDependence::move_to(const Trajectory& trajectory, const Eigen::MatrixXd& map_jacobian) {
  trajectory_ = &trajectory;
  map_jacobian_ = &map_jacobian;
  ++point_;
}

/// Derivatives at a step that include those of a row, which are at `at`.
const ValueDependence::StepDerivatives& ValueDependence::differentiate(int step, int row,
                                                                       Eigen::Index& at) {
  StepDerivatives& out = steps_[static_cast<std::size_t>(step)];
  const auto found = std::find(out.rows.begin(), out.rows.end(), row);
  at = found - out.rows.begin();
  if (found == out.rows.end()) {
    out.rows.push_back(row);
    out.point = -1;
  }
  if (out.point != point_) {
    pull_back_rows(step, out);
    out.point = point_;
  }
  return out;
}

void ValueDependence::pull_back_rows(int step, StepDerivatives& out) {
  const auto count = static_cast<Eigen::Index>(out.rows.size());
  out.by_q.resize(count, layout_.dof());
  out.by_qdot.resize(count, layout_.dof());
  out.by_u.resize(count, head_.control_count());
  out.by_d.resize(count, head_.design_count());
  const Inputs& inputs = trajectory_->inputs;
  const int stage = layout_.stage_of_step(step);
  const Applied<double> applied{*trajectory_->mechanism, horizon_.parameters(), inputs.p};
  const Instant<double> instant =
      instants_.at(applied, trajectory_->q.col(stage), trajectory_->qdot.col(stage),
                   inputs.u.col(measured_step(step)));
  measurements_.linearize(instant);
  for (Eigen::Index i = 0; i < count; ++i) {
    by_q_.setZero(layout_.dof());
    by_qdot_.setZero(layout_.dof());
    by_u_.setZero(head_.control_count());
    by_p_.setZero(inputs.p.size());
    InstantGradient<double> by{by_q_, by_qdot_, by_u_, by_p_};
    double& weight = weights_[out.rows[static_cast<std::size_t>(i)]];
    weight = 1.0;
    measurements_.pull_back(instant, weights_, by);
    weight = 0.0;
    out.by_q.row(i) = by_q_;
    out.by_qdot.row(i) = by_qdot_;
    out.by_u.row(i) = by_u_;
    out.by_d.row(i) = by_p_.transpose() * *map_jacobian_;
  }
}

void ValueDependence::derivatives_of(const ValuePlace& place, std::vector<double>& out) {
  out.clear();
  if (place.field == ValueField::kU) {
    out.push_back(1.0);
    return;
  }
  if (place.field == ValueField::kP) {
    for (const Eigen::Index i : head_.designs_of(place.index)) {
      out.push_back((*map_jacobian_)(place.index, i));
    }
    return;
  }
  const std::vector<StageRun>& runs = layout_.runs(layout_.stage_of_step(place.step));
  if (place.field != ValueField::kMeasured) {
    for (const StageRun& run : runs) {
      const double weight = place.field == ValueField::kQ ? run.q : run.qdot;
      if (weight != 0.0) {
        out.push_back(weight);
      }
    }
    return;
  }
  Eigen::Index at = 0;
  const StepDerivatives& by = differentiate(place.step, place.index, at);
  for (Eigen::Index i = 0; i < by.by_d.cols(); ++i) {
    out.push_back(by.by_d(at, i));
  }
  for (const int control : reads(place.index).controls) {
    out.push_back(by.by_u(at, control));
  }
  for (const StageRun& run : runs) {
    for (int c = 0; c < layout_.dof(); ++c) {
      if (depends(reads(place.index), run, c)) {
        out.push_back(run.q * by.by_q(at, c) + run.qdot * by.by_qdot(at, c));
      }
    }
  }
}

}  // namespace hbar
