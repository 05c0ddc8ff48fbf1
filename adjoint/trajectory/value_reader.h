#pragma once

#include <vector>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"

namespace hbar {

/// Reads off trajectories what objectives, constraints and people want to know.
///
/// Holds its workspace and belongs to one thread at a time.
class ValueReader {
 public:
  explicit ValueReader(Horizon horizon);

  /// The values at the steps' ends of a trajectory of the horizon. Measurements read the control of
  /// the step that ends, at k = 0 that of the first step.
  [[nodiscard]] TrajectoryValues values(const Trajectory& trajectory);

  /// What each contact did at the steps' ends: [step 0 … N][contact].
  [[nodiscard]] std::vector<std::vector<ContactSummary>> contact_history(
      const Trajectory& trajectory);

 private:
  Horizon horizon_;
  Measurements<double> measurements_;
  InstantMotion<double> instants_;
  Motion<double> motion_;
  ContactForces<double> contacts_;
  Eigen::VectorXd none_;  // accelerations, which nothing here reads
};

/// ValueReader::values of one trajectory.
[[nodiscard]] TrajectoryValues read_values(const Horizon& horizon, const Trajectory& trajectory);

/// ValueReader::contact_history of one trajectory.
[[nodiscard]] std::vector<std::vector<ContactSummary>> contact_history(
    const Horizon& horizon, const Trajectory& trajectory);

/// What is measured of a trajectory, sized but zero: what terms ask for before there is one.
[[nodiscard]] TrajectoryValues value_shape(const Horizon& horizon);

}  // namespace hbar
