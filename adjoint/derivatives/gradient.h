#pragma once

#include "hbar/adjoint/terms/objective.h"
#include "hbar/core/base/owned.h"

namespace hbar {

class Horizon;
struct Trajectory;

/// dΨ/d(p, u, q₀, q̇₀), shaped like Inputs, and Ψ itself.
struct Gradient {
  double value = 0.0;     ///< Ψ
  Eigen::VectorXd p;      ///<                                            [parameters]
  Eigen::MatrixXd u;      ///<                                            [controls x steps]
  Eigen::VectorXd q0;     ///<                                            [dof]
  Eigen::VectorXd qdot0;  ///<                                            [dof]
};

/// The adjoint of a trajectory, swept backward stage by stage: H̄ᵀ z̄ = ȳ (20) by block substitution
/// and the contraction (21), without forming H̄ or ∂ḡ/∂p.
///
/// Each stage's block system H_ssᵀ z = y is solved with the factors that Newton left behind, one
/// step short of the solution, and refined against the exact block until the residual is at
/// rounding level; where that does not converge, or no factors were kept, the block is factorised
/// again.
///
/// Holds its workspace for one horizon and belongs to one thread at a time.
class AdjointSweep {
 public:
  explicit AdjointSweep(const Horizon& horizon);
  ~AdjointSweep();
  AdjointSweep(AdjointSweep&&) noexcept;
  AdjointSweep& operator=(AdjointSweep&&) noexcept;

  /// @param trajectory  complete, of this horizon
  /// @throws InvalidInput for a trajectory of another horizon, or a part of one
  /// @throws NumericalFailure if a stage's block is singular or its residual stays above 1e-11
  /// @throws Interrupted if the horizon's stop flag is set before a stage
  [[nodiscard]] Gradient gradient(const Trajectory& trajectory, const Objective& objective);

  /// The same from given partials (the value is left at 0).
  [[nodiscard]] Gradient pull_back(const Trajectory& trajectory,
                                   const TrajectoryPartials& partials);

  /// z̄ of the last sweep: the sensitivity of Ψ to each stage's residual. [dof x stages − 1]
  [[nodiscard]] const Eigen::MatrixXd& adjoint() const;
  /// Largest relative residual ‖y − H_ssᵀ z‖ / (‖y‖ + …) of the last sweep's stages.
  [[nodiscard]] double worst_residual() const;
  /// How many stages of the last sweep had to be factorised again.
  [[nodiscard]] int refactorized() const;

 private:
  struct Workspace;
  Owned<Workspace> work_;
};

/// dΨ of a trajectory: one AdjointSweep.
[[nodiscard]] Gradient gradient(const Horizon& horizon, const Trajectory& trajectory,
                                const Objective& objective);

}  // namespace hbar
