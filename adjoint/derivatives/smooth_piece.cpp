#include "hbar/adjoint/derivatives/smooth_piece.h"

#include <algorithm>
#include <variant>

namespace hbar {
namespace {

/// Which face of a solid with edges has the normal n, in its frame.
int face(const Shape& shape, const Eigen::Vector3d& n) {
  if (std::holds_alternative<Cylinder>(shape)) {
    return std::abs(n.z()) > 0.5 ? 1 : 0;
  }
  int axis = 0;
  if (std::holds_alternative<Cuboid>(shape) && n.cwiseAbs().maxCoeff(&axis) > 0.5) {
    return n[axis] > 0.0 ? axis + 1 : -axis - 1;
  }
  return 0;
}

}  // namespace

SmoothPieceReader::SmoothPieceReader(const Horizon& horizon)
    : horizon_(horizon),
      motion_(horizon.model().tree()),
      contacts_(horizon.model()),
      none_(Eigen::VectorXd::Zero(horizon.model().dof())) {}

std::vector<int> SmoothPieceReader::read(const Trajectory& trajectory,
                                         const TrajectoryValues& values) {
  const Model& model = horizon_.model();
  std::vector<int> piece;
  for (int k = 0; k <= trajectory.step_count(); ++k) {
    piece.push_back(trajectory.timeline.step_end(k));
  }
  for (const ChartSwitch& change : trajectory.chart_switches) {
    piece.insert(piece.end(), {change.stage, change.node});
  }
  if (model.contact_count() > 0) {
    const int first = values.declared_count() > 0 ? 0 : 1;  // measured at the start, too
    for (int stage = first; stage < trajectory.timeline.stage_count(); ++stage) {
      read_contacts(trajectory, stage, piece);
    }
  }
  read_sensors(values, piece);
  return piece;
}

void SmoothPieceReader::read_contacts(const Trajectory& trajectory, int stage,
                                      std::vector<int>& piece) {
  const Model& model = horizon_.model();
  compute_motion<double>(model.tree(), *trajectory.mechanism, trajectory.q.col(stage),
                         trajectory.qdot.col(stage), none_, motion_);
  contacts_.linearize(*trajectory.mechanism, motion_);
  for (const ActivePair<double>& pair : contacts_.active()) {
    const Contact& contact = model.contact(pair.contact);
    const bool own = std::holds_alternative<OwnShape>(contact.surface);
    const Shape& shape = model.link(std::max(contact.other, 0)).body.shape;
    for (const TouchingPoint<double>& point : contacts_.points(pair)) {
      const double normal = point.force.normal;
      piece.insert(piece.end(),
                   {pair.contact, point.index, point.force.sticks ? 1 : 0,
                    static_cast<int>(normal > 0.0) - static_cast<int>(normal < 0.0),
                    own ? face(shape, pair.motion.b.X_WB.R.transpose() * point.n) : 0});
    }
  }
  piece.push_back(-1);
}

/// Which points of sensors touch and, of these, which slide: their shear is at its bound.
void SmoothPieceReader::read_sensors(const TrajectoryValues& values,
                                     std::vector<int>& piece) const {
  for (Eigen::Index k = 0; k < values.tactile().cols(); ++k) {
    Eigen::Index at = 0;
    for (const TactileSensor& sensor : horizon_.model().tactile_sensors()) {
      for (Eigen::Index i = 0; i < sensor.points.cols(); ++i, at += 3) {
        const Eigen::Vector3d reading = values.tactile().col(k).segment<3>(at);
        const double bound = sensor.coefficients.mu * std::abs(reading[2]);
        const bool slides = reading.head<2>().norm() > (1.0 - 1e-9) * bound;
        piece.push_back(reading[2] == 0.0 ? 0 : slides ? 1 : 2);
      }
    }
  }
}

}  // namespace hbar
