#pragma once

#include <vector>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"

namespace hbar {

/// Extracts from trajectories the numbers that objectives, constraints and users need.
///
/// Holds its workspace and belongs to one thread at a time.
class ValueReader {
 public:
  explicit ValueReader(Horizon horizon);

  /// The values of a trajectory of the horizon at the ends of its steps. Measurements read the
  /// control of the step that ends, and at k = 0 that of the first step.
  [[nodiscard]] TrajectoryValues values(const Trajectory& trajectory);

  /// What each contact did at the ends of the steps: [step 0 … N][contact].
  [[nodiscard]] std::vector<std::vector<ContactSummary>> contact_history(
      const Trajectory& trajectory);

  /// What each contact does in the initial state.                                    [contact]
  [[nodiscard]] std::vector<ContactSummary> contacts_at_start(const Inputs& inputs);

 private:
  [[nodiscard]] std::vector<ContactSummary> contacts_at(const Mechanism<double>& mechanism,
                                                        const Eigen::VectorXd& q,
                                                        const Eigen::VectorXd& qdot);

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

/// The values of a trajectory, correctly sized but zero: for terms that need the shape before there
/// is a trajectory.
[[nodiscard]] TrajectoryValues value_shape(const Horizon& horizon);

}  // namespace hbar
