#pragma once

#include "hbar/adjoint/outputs/instant_outputs.h"
#include "hbar/adjoint/trajectory/simulator.h"

namespace hbar {

/// Reads off a trajectory what objectives, constraints and people want to know: Simulator's part
/// that comes after simulating.
///
/// Borrows the model; holds its workspace and belongs to one thread at a time.
class ValueReader {
 public:
  /// @throws InvalidInput if the model cannot have the measurements
  ValueReader(const Model& model, const std::vector<Measurement>& measurements);

  /// The values at the steps' ends.
  ///
  /// @param set  of the trajectory's parameters
  /// @param h    nominal time step
  [[nodiscard]] TrajectoryValues values(const ParameterSet& set, const Trajectory& trajectory,
                                        double h);

  /// What each contact did at the steps' ends: [step 0 … N][contact].
  [[nodiscard]] std::vector<std::vector<ContactSummary>> contact_history(
      const ParameterSet& set, const Trajectory& trajectory);

  /// Names of the measured rows.
  [[nodiscard]] const std::vector<std::string>& measured_names() const {
    return outputs_.measured_names();
  }

 private:
  const Model& model_;
  Mechanism<double> mechanism_;
  Motion<double> motion_;
  InstantOutputs<double> outputs_;
  OutputRows<double> rows_;
  ContactForces<double> contacts_;
  Eigen::VectorXd none_;  // accelerations, which nothing here reads
};

}  // namespace hbar
