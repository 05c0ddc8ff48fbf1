#pragma once

#include <Eigen/Core>

namespace hbar {

/// Which rows of TrajectoryValues::measured belong to what: first the end effectors', then the
/// tactile sensors', then those of SimulationOptions::measurements.
struct MeasuredRows {
  Eigen::Index variables = 0;  ///< of the end effectors: the auxiliary variables v
  Eigen::Index tactile = 0;    ///< of the tactile sensors
};

/// The numbers that a model measures, or a derivative with respect to each of them. Time runs along
/// columns, k = 0 … N.
struct Measured {
  Eigen::MatrixXd measured = {};  ///<                                       [measured x N+1]
  MeasuredRows measured_rows = {};

  /// Auxiliary variables, length.                                            [variables x N+1]
  [[nodiscard]] auto v() { return measured.topRows(measured_rows.variables); }
  [[nodiscard]] auto v() const { return measured.topRows(measured_rows.variables); }
  /// Sensor readings, force.                                                 [readings x N+1]
  [[nodiscard]] auto tactile() {
    return measured.middleRows(measured_rows.variables, measured_rows.tactile);
  }
  [[nodiscard]] auto tactile() const {
    return measured.middleRows(measured_rows.variables, measured_rows.tactile);
  }
  /// The rows of SimulationOptions::measurements.                            [declared x N+1]
  [[nodiscard]] auto declared() { return measured.bottomRows(declared_count()); }
  [[nodiscard]] auto declared() const { return measured.bottomRows(declared_count()); }
  [[nodiscard]] Eigen::Index declared_count() const {
    return measured.rows() - measured_rows.variables - measured_rows.tactile;
  }
};

/// The numbers that objectives, constraints and result files read. Time runs along columns, k = 0 …
/// N.
struct TrajectoryValues : Measured {
  double h = 0.0;        ///< nominal time step
  Eigen::MatrixXd q;     ///< rad or length                               [dof x N+1]
  Eigen::MatrixXd qdot;  ///<                                             [dof x N+1]
  Eigen::MatrixXd u;     ///< controls                                    [controls x N]
  Eigen::VectorXd p;     ///< design parameters                           [parameters]
};

}  // namespace hbar
