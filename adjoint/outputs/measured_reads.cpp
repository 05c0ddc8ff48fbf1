#include "hbar/adjoint/outputs/measured_reads.h"

#include <algorithm>
#include <iterator>

#include "hbar/core/model/drives.h"
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

/// Coordinates that move a link, ascending; none for the world.
Coordinates path_of_link(const Model& model, int link) {
  Coordinates out;
  for (int c = 0; link >= 0 && c < model.dof(); ++c) {
    if (model.tree().is_on_path(model.tree().node_of(c), model.node_of_link(link))) {
      out.push_back(c);
    }
  }
  return out;
}

/// Coordinates that move one link relative to the other: those that move both do not count.
Coordinates relative_path(const Model& model, int a, int b) {
  const Coordinates moves_a = path_of_link(model, a);
  const Coordinates moves_b = path_of_link(model, b);
  Coordinates out;
  std::set_symmetric_difference(moves_a.begin(), moves_a.end(), moves_b.begin(), moves_b.end(),
                                std::back_inserter(out));
  return out;
}

/// Coordinates, rates and controls that each row of a measurement reads.
struct RowReads {
  const Model& model;

  std::vector<MeasuredReads> operator()(const PointVelocity& m) const {
    const Coordinates path = path_of_link(model, m.link);
    return std::vector<MeasuredReads>(3, {path, path, {}});
  }
  std::vector<MeasuredReads> operator()(const Orientation& m) const {
    return std::vector<MeasuredReads>(3, {path_of_link(model, m.link), {}, {}});
  }
  std::vector<MeasuredReads> operator()(const BodyDistance& m) const {
    return {{relative_path(model, m.link, m.other), {}, {}}};
  }
  std::vector<MeasuredReads> operator()(const ContactForce& m) const {
    const Coordinates coupled = coupled_coordinates(model, model.contact(m.contact));
    return std::vector<MeasuredReads>(4, {coupled, coupled, {}});
  }
  std::vector<MeasuredReads> operator()(const MotorTorque& m) const {
    std::vector<MeasuredReads> out;
    for_each_drive(model, m.motor, [&](int c, int control) {
      const Coordinates own = is_servo(m.motor) ? Coordinates{c} : Coordinates{};
      out.push_back({own, own, {control}});
    });
    return out;
  }
  std::vector<MeasuredReads> operator()(const MotorPower& m) const {
    MeasuredReads out;
    for_each_drive(model, m.motor, [&](int c, int control) {
      if (is_servo(m.motor)) {
        out.q.push_back(c);
      }
      out.qdot.push_back(c);
      out.controls.push_back(control);
    });
    return {out};
  }
  std::vector<MeasuredReads> operator()(const CentreOfMass&) const {
    return std::vector<MeasuredReads>(3, {all_coordinates(model), {}, {}});
  }
  std::vector<MeasuredReads> operator()(const LinearMomentum&) const {
    const Coordinates all = all_coordinates(model);
    return std::vector<MeasuredReads>(3, {all, all, {}});
  }

  std::vector<MeasuredReads> operator()(const EndEffectorPosition& m) const {
    const auto& point = model.end_effectors()[static_cast<std::size_t>(m.end_effector)];
    return std::vector<MeasuredReads>(3, {path_of_link(model, point.link), {}, {}});
  }
  std::vector<MeasuredReads> operator()(const TactileReading& m) const {
    const auto& sensor = model.tactile_sensors()[static_cast<std::size_t>(m.sensor)];
    const Coordinates all = all_coordinates(model);
    return {3 * static_cast<std::size_t>(sensor.points.cols()), {all, all, {}}};
  }

  [[nodiscard]] bool is_servo(int motor) const {
    return model.motors()[static_cast<std::size_t>(motor)].kind == Motor::Kind::kPosition;
  }
};

}  // namespace

std::vector<MeasuredReads> measured_reads(const Model& model, const Measurement& measurement) {
  return std::visit(RowReads{model}, measurement);
}

}  // namespace hbar
