#pragma once

#include <vector>

#include "hbar/adjoint/outputs/measured_reads.h"
#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/programs/stage_layout.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/adjoint/trajectory/value_place.h"

namespace hbar {

/// How the numbers that terms read depend on the variables of all-at-once: which entries of x
/// affect each, and how strongly. An instant is linearised once for all of its rows, and a row is
/// pulled back once per point, however often it is requested.
///
/// Holds its workspace and belongs to one thread at a time.
class ValueDependence {
 public:
  /// @param head, layout  must outlive this object
  ValueDependence(const Horizon& horizon, const InputVariables& head, const StageLayout& layout);

  /// The entries of x that a number depends on; always the same.
  [[nodiscard]] std::vector<Eigen::Index> columns_of(const ValuePlace& place) const;

  /// Sets the point at which derivatives_of evaluates.
  ///
  /// @param trajectory    must not change until the next move
  /// @param map_jacobian  of the design map; likewise                    [parameters x designs]
  void move_to(const Trajectory& trajectory, const Eigen::MatrixXd& map_jacobian);
  /// A number's derivatives with respect to columns_of(place).
  void derivatives_of(const ValuePlace& place, std::vector<double>& out);

  /// What a measured row reads.
  [[nodiscard]] const MeasuredReads& reads(int row) const {
    return reads_[static_cast<std::size_t>(row)];
  }

 private:
  /// Derivatives of the rows requested at one step, with respect to what they read.
  struct StepDerivatives {
    std::vector<int> rows;    // in the order in which they were asked for
    int point = -1;           // of which the rest is
    Eigen::MatrixXd by_q;     // [rows x dof]
    Eigen::MatrixXd by_qdot;  // [rows x dof]
    Eigen::MatrixXd by_u;     // [rows x controls]
    Eigen::MatrixXd by_d;     // [rows x designs]
  };

  [[nodiscard]] static bool depends(const MeasuredReads& reads, const StageRun& run,
                                    int coordinate);
  const StepDerivatives& differentiate(int step, int row, Eigen::Index& at);
  void pull_back_rows(int step, StepDerivatives& out);

  Horizon horizon_;
  const InputVariables& head_;
  const StageLayout& layout_;
  std::vector<MeasuredReads> reads_;  // per measured row
  Measurements<double> measurements_;
  InstantMotion<double> instants_;
  std::vector<StepDerivatives> steps_;  // per step 0 … N
  const Trajectory* trajectory_ = nullptr;
  const Eigen::MatrixXd* map_jacobian_ = nullptr;
  int point_ = 0;
  Eigen::VectorXd weights_, by_q_, by_qdot_, by_u_, by_p_;
};

}  // namespace hbar
