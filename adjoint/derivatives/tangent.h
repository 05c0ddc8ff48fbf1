#pragma once

#include "hbar/adjoint/derivatives/factorized_linearization.h"
#include "hbar/adjoint/terms/objective.h"

namespace hbar {

/// Directions in which the inputs change, one per column.
struct Directions {
  Eigen::MatrixXd p;      ///<                                        [parameters x count]
  Eigen::MatrixXd u;      ///< step by step                           [controls·steps x count]
  Eigen::MatrixXd q0;     ///<                                        [dof x count]
  Eigen::MatrixXd qdot0;  ///<                                        [dof x count]

  /// `count` directions, all zero.
  [[nodiscard]] static Directions zero(const Horizon& horizon, Eigen::Index count);
  [[nodiscard]] Eigen::Index count() const { return p.cols(); }
};

/// How the trajectory changes along the directions: one column each, time step after time step.
struct Tangents {
  Eigen::MatrixXd q;         ///< rows k·dof … are step k's               [dof·(N+1) x count]
  Eigen::MatrixXd qdot;      ///<                                         [dof·(N+1) x count]
  Eigen::MatrixXd measured;  ///< measurements                        [measured·(N+1) x count]
};

/// Forward sensitivities H̄ δq̄ = −(∂ḡ/∂p) δp − … with the matrices of Linearizer and any solver.
///
/// Holds its workspace for one horizon and belongs to one thread at a time.
class TangentSweep {
 public:
  /// @param factory  of the solver for H̄; null means block substitution
  explicit TangentSweep(const Horizon& horizon, solvers::SolverFactory factory = nullptr);

  /// @param trajectory  complete, of this horizon
  /// @throws NumericalFailure if H̄ is singular or a residual is too large
  [[nodiscard]] Tangents push_forward(const Trajectory& trajectory, const Directions& directions);

  /// The system assembled last.
  [[nodiscard]] const Linearization& linearization() const { return system_.linearization(); }
  /// −∂ḡ·directions of the last call: the right-hand sides of the solve with H̄.  [m x count]
  [[nodiscard]] const Eigen::MatrixXd& right_hand_sides() const { return rhs_; }
  [[nodiscard]] const solvers::LinearSolver& solver() const { return system_.solver(); }

 private:
  Horizon horizon_;
  FactorizedLinearization system_;
  Eigen::MatrixXd rhs_;
};

/// dΨ along one direction (column `i` of tangents and directions).
[[nodiscard]] double directional_derivative(const TrajectoryPartials& partials,
                                            const Tangents& tangents, const Directions& directions,
                                            Eigen::Index i);

/// Σ over the members of Tangents of ‖partials‖ ‖tangents‖: the yardstick for rounding errors in
/// dΨ.
[[nodiscard]] double norm_product(const TrajectoryPartials& partials, const Tangents& tangents);

}  // namespace hbar
