// How the numbers that terms read depend on the variables of AllAtOnce.
#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <variant>

#include "hbar/adjoint/programs/all_at_once.h"
#include "hbar/core/parameters/sparsity.h"

namespace hbar {
namespace {

using Coordinates = std::vector<int>;

Coordinates all_coordinates(const Model& model) {
  Coordinates out;
  for (int c = 0; c < model.dof(); ++c) {
    out.push_back(c);
  }
  return out;
}

/// Coordinates that move a link, ascending; none of the world.
Coordinates path_of_link(const Model& model, int link) {
  Coordinates out;
  for (int c = 0; link >= 0 && c < model.dof(); ++c) {
    if (model.tree().is_on_path(model.tree().node_of(c), model.node_of_link(link))) {
      out.push_back(c);
    }
  }
  return out;
}

/// Coordinates that move one link against the other: what moves both leaves them as they are.
Coordinates relative_path(const Model& model, int a, int b) {
  const Coordinates moves_a = path_of_link(model, a);
  const Coordinates moves_b = path_of_link(model, b);
  Coordinates out;
  std::set_symmetric_difference(moves_a.begin(), moves_a.end(), moves_b.begin(), moves_b.end(),
                                std::back_inserter(out));
  return out;
}

/// Coordinates that a motor drives.
CoordinateRange driven_by(const Model& model, int motor) {
  return model.coordinates_of_link(model.motors()[static_cast<std::size_t>(motor)].link);
}

/// Coordinates, rates and controls that each row of a measurement reads.
template <typename Reads>
struct RowReads {
  const Model& model;

  std::vector<Reads> operator()(const PointVelocity& m) const {
    const Coordinates path = path_of_link(model, m.link);
    return std::vector<Reads>(3, {path, path, {}});
  }
  std::vector<Reads> operator()(const Orientation& m) const {
    return std::vector<Reads>(3, {path_of_link(model, m.link), {}, {}});
  }
  std::vector<Reads> operator()(const BodyDistance& m) const {
    return {{relative_path(model, m.link, m.other), {}, {}}};
  }
  std::vector<Reads> operator()(const ContactForce& m) const {
    const Coordinates coupled = coupled_coordinates(model, model.contact(m.contact));
    return std::vector<Reads>(4, {coupled, coupled, {}});
  }
  std::vector<Reads> operator()(const MotorTorque& m) const {
    const bool servo = is_servo(m.motor);
    std::vector<Reads> out;
    const CoordinateRange range = driven(m.motor);
    for (int c = range.begin; c < range.end; ++c) {
      const Coordinates own = servo ? Coordinates{c} : Coordinates{};
      out.push_back({own, own, {model.first_control(m.motor) + c - range.begin}});
    }
    return out;
  }
  std::vector<Reads> operator()(const MotorPower& m) const {
    Reads out;
    const CoordinateRange range = driven(m.motor);
    for (int c = range.begin; c < range.end; ++c) {
      if (is_servo(m.motor)) {
        out.q.push_back(c);
      }
      out.qdot.push_back(c);
      out.controls.push_back(model.first_control(m.motor) + c - range.begin);
    }
    return {out};
  }
  std::vector<Reads> operator()(const CentreOfMass&) const {
    return std::vector<Reads>(3, {all_coordinates(model), {}, {}});
  }
  std::vector<Reads> operator()(const LinearMomentum&) const {
    const Coordinates all = all_coordinates(model);
    return std::vector<Reads>(3, {all, all, {}});
  }

  [[nodiscard]] bool is_servo(int motor) const {
    return model.motors()[static_cast<std::size_t>(motor)].kind == Motor::Kind::kPosition;
  }
  [[nodiscard]] CoordinateRange driven(int motor) const { return driven_by(model, motor); }
};

bool holds(const Coordinates& coordinates, int c) {
  return std::binary_search(coordinates.begin(), coordinates.end(), c);
}

}  // namespace

void AllAtOnce::lay_out_outputs() {
  const Model& model = problem_.horizon.model();
  for (const EndEffector& end_effector : model.end_effectors()) {
    variable_reads_.push_back({path_of_link(model, end_effector.link), {}, {}});
  }
  const Coordinates all = all_coordinates(model);
  tactile_reads_ = {all, all, {}};
  for (const Measurement& measurement : problem_.horizon.options().measurements) {
    const auto rows = std::visit(RowReads<OutputReads>{model}, measurement);
    measured_reads_.insert(measured_reads_.end(), rows.begin(), rows.end());
  }
  lay_out_pairs();
}

/// By which pairs anything has second derivatives: of coordinates (the residual's, and where
/// outputs read bodies of two branches), of a control and a rate (a motor's power), of a design
/// variable and a control (a motor's P).
void AllAtOnce::lay_out_pairs() {
  const Model& model = problem_.horizon.model();
  pairs_ = residual_pattern(model);
  if (model.tactile_count() > 0) {
    pairs_.assign(pairs_.size(), all_coordinates(model));
  }
  std::vector<std::set<int>> own;
  for (const std::vector<int>& others : pairs_) {
    own.emplace_back(others.begin(), others.end());
  }
  std::set<std::pair<int, int>> powers;
  for (const Measurement& measurement : problem_.horizon.options().measurements) {
    const auto rows = std::visit(RowReads<OutputReads>{model}, measurement);
    if (std::holds_alternative<BodyDistance>(measurement)) {
      for (const int c : rows[0].q) {
        own[static_cast<std::size_t>(c)].insert(rows[0].q.begin(), rows[0].q.end());
      }
    }
    if (std::holds_alternative<MotorPower>(measurement)) {
      for (std::size_t i = 0; i < rows[0].controls.size(); ++i) {
        powers.emplace(rows[0].controls[i], rows[0].qdot[i]);  // once, if measured twice
      }
    }
  }
  control_rates_.assign(powers.begin(), powers.end());
  for (const std::set<int>& others : own) {
    own_pairs_.emplace_back(others.begin(), others.end());
  }
  std::set<std::pair<Eigen::Index, int>> gains;
  for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
    const int gain = problem_.horizon.parameters().index(ParameterKind::kMotorP, m, 0);
    if (gain >= 0) {
      const CoordinateRange range = driven_by(model, m);
      for (const Eigen::Index i : head_.designs_of(gain)) {
        for (int c = range.begin; c < range.end; ++c) {
          gains.emplace(i, model.first_control(m) + c - range.begin);
        }
      }
    }
  }
  gain_controls_.assign(gains.begin(), gains.end());
}

const std::vector<int>& AllAtOnce::pairs_of(const StageEntry& a, const StageEntry& b,
                                            int coordinate) const {
  const bool own = a.q != 0.0 && b.q != 0.0;
  return (own ? own_pairs_ : pairs_)[static_cast<std::size_t>(coordinate)];
}

const AllAtOnce::OutputReads& AllAtOnce::reads_of(const ValuePlace& place) const {
  const auto row = static_cast<std::size_t>(place.index);
  if (place.field == ValueField::kV) {
    return variable_reads_[row / 3];
  }
  return place.field == ValueField::kMeasured ? measured_reads_[row] : tactile_reads_;
}

/// Whether a row may change with a coordinate of a run of x.
bool AllAtOnce::depends(const OutputReads& reads, const StageEntry& entry, int coordinate) {
  return (entry.q != 0.0 && holds(reads.q, coordinate)) ||
         (entry.qdot != 0.0 && holds(reads.qdot, coordinate));
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
  const OutputReads& reads = reads_of(place);
  const int block = head_.block_of_step(measured_step(place.step));
  for (const int control : reads.controls) {
    out.push_back(head_.control_place(block) + control);
  }
  for (const StageEntry& entry : entries) {
    for (int c = 0; c < problem_.horizon.model().dof(); ++c) {
      if (depends(reads, entry, c)) {
        out.push_back(entry.place + c);
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
  outputs_.pull_back(*trajectory_.mechanism, problem_.horizon.parameters(), trajectory_.inputs.p,
                     outputs_.motion_at(*trajectory_.mechanism, q, qdot), q, qdot,
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
  const OutputReads& reads = reads_of(place);
  for (const int control : reads.controls) {
    out.push_back(by_u_[control]);
  }
  for (const StageEntry& entry : entries) {
    for (int c = 0; c < problem_.horizon.model().dof(); ++c) {
      if (depends(reads, entry, c)) {
        out.push_back(entry.q * by_q_[c] + entry.qdot * by_qdot_[c]);
      }
    }
  }
}

}  // namespace hbar
