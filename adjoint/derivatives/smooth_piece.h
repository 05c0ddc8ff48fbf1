#pragma once

#include <vector>

#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/contact/contact_forces.h"

namespace hbar {

/// Distinguishes the smooth pieces of an objective Ψ. Contact puts a kink wherever, at some stage,
/// a point begins to touch, to slide or to sense another face, and halved steps and changes of
/// chart make Ψ jump: differences across such a place mix the derivatives of both sides.
class SmoothPieceReader {
 public:
  explicit SmoothPieceReader(const Horizon& horizon);

  /// Numbers that agree for two trajectories exactly if no such place separates them.
  ///
  /// @param values  of the trajectory
  [[nodiscard]] std::vector<int> read(const Trajectory& trajectory, const TrajectoryValues& values);

 private:
  void read_contacts(const Trajectory& trajectory, int stage, std::vector<int>& piece);
  void read_sensors(const TrajectoryValues& values, std::vector<int>& piece) const;

  Horizon horizon_;
  Motion<double> motion_;
  ContactForces<double> contacts_;
  Eigen::VectorXd none_;
};

}  // namespace hbar
