#pragma once

#include <memory>

#include "hbar/adjoint/gradient.h"
#include "hbar/adjoint/linearization.h"

namespace hbar {

/// The gradient (20), (21) by its matrices: H̄ᵀ z̄ = ȳ with any sparse solver, then
/// ∂Ψ/∂p − z̄ᵀ ∂ḡ/∂p. What AdjointSweep does without them, for comparing solvers and as a witness.
///
/// Holds its workspace for one simulator and belongs to one thread at a time.
class AssembledAdjoint {
 public:
  /// @param solver  for H̄; null means block substitution
  explicit AssembledAdjoint(Simulator& simulator,
                            std::unique_ptr<solvers::LinearSolver> solver = nullptr);

  /// @param trajectory  whole, of this simulator
  /// @throws NumericalFailure if H̄ is singular or the residual is too large
  [[nodiscard]] Gradient gradient(const Trajectory& trajectory, const Objective& objective);

  /// The same from given partials (the value is left at 0).
  [[nodiscard]] Gradient pull_back(const Trajectory& trajectory,
                                   const TrajectoryPartials& partials);

  /// z̄ of the last call.                                                        [m]
  [[nodiscard]] const Eigen::VectorXd& adjoint() const { return z_bar_; }
  /// The system of the last call.
  [[nodiscard]] const Linearization& linearization() const { return *linearization_; }
  [[nodiscard]] const solvers::LinearSolver& solver() const { return *solver_; }

 private:
  void solve(const Trajectory& trajectory, const Eigen::VectorXd& y_bar);

  Simulator& simulator_;
  Linearizer linearizer_;
  std::unique_ptr<solvers::LinearSolver> solver_;
  bool owns_block_solver_ = false;
  int analyzed_pattern_ = 0;
  const Linearization* linearization_ = nullptr;
  Eigen::VectorXd z_bar_;
};

}  // namespace hbar
