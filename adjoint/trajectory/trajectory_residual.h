#pragma once

#include "hbar/adjoint/trajectory/simulator.h"

namespace hbar {

/// ḡ(q̄, p, u, q₀, q̇₀) at coordinates q̄ that need not solve it: the view of methods for which the
/// whole trajectory is unknown. The timeline, and where charts change, are given.
///
/// Holds its workspace for one simulator and belongs to one thread at a time.
class TrajectoryResidual {
 public:
  explicit TrajectoryResidual(Simulator& simulator);

  /// Computes the rates of every stage from its coordinates, and ḡ with them.
  ///
  /// @param trajectory  of this simulator's model; q, timeline and inputs are read, and column 0 of
  ///                    qdot; the other columns of qdot are overwritten
  /// @returns  ḡ, stage by stage; valid until the next call                     [dof·(stages − 1)]
  const Eigen::VectorXd& evaluate(Trajectory& trajectory);

 private:
  Simulator& simulator_;
  Mechanism<double> mechanism_;
  StageResidual<double> stage_;
  StagePoint<double> point_;
  Eigen::VectorXd g_;
  Eigen::VectorXd g_bar_;
};

}  // namespace hbar
