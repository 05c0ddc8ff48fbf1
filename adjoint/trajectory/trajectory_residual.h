#pragma once

#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// ḡ(q̄, p, u, q₀, q̇₀) at coordinates q̄ that need not make it zero, for methods whose unknown is
/// the whole trajectory. The timeline and the chart switches are given.
///
/// Holds its workspace for one horizon and belongs to one thread at a time.
class TrajectoryResidual {
 public:
  explicit TrajectoryResidual(const Horizon& horizon);

  /// Computes the rates of every stage from the coordinates, and then ḡ.
  ///
  /// @param trajectory  of this horizon's model; q, timeline, inputs, mechanism and column 0 of
  ///                    qdot are read; the other columns of qdot are overwritten
  /// @returns  ḡ, stage by stage; valid until the next call                     [dof·(stages − 1)]
  const Eigen::VectorXd& evaluate(Trajectory& trajectory);

 private:
  Horizon horizon_;
  History history_;
  StageResidual<double> stage_;
  StagePoint<double> point_;
  Eigen::VectorXd g_;
  Eigen::VectorXd g_bar_;
};

}  // namespace hbar
