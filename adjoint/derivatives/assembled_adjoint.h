#pragma once

#include "hbar/adjoint/derivatives/factorized_linearization.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/solvers/linear/solver_choice.h"

namespace hbar {

/// The gradient (20), (21) from assembled matrices: H̄ᵀ z̄ = ȳ with any sparse solver, then
/// ∂Ψ/∂p − z̄ᵀ ∂ḡ/∂p. AdjointSweep computes the same without forming them; this class serves to
/// compare solvers and as an independent check.
///
/// Holds its workspace for one horizon and belongs to one thread at a time.
class AssembledAdjoint {
 public:
  /// @param factory  of the solver for H̄; null means block substitution
  explicit AssembledAdjoint(const Horizon& horizon, solvers::SolverFactory factory = nullptr);

  /// @param trajectory  complete, of this horizon
  /// @throws NumericalFailure if H̄ is singular or the residual is too large
  [[nodiscard]] Gradient gradient(const Trajectory& trajectory, const Objective& objective);

  /// The same from given partials (the value is left at 0).
  [[nodiscard]] Gradient pull_back(const Trajectory& trajectory,
                                   const TrajectoryPartials& partials);

  /// z̄ of the last call.                                                        [m]
  [[nodiscard]] const Eigen::VectorXd& adjoint() const { return z_bar_; }
  /// The system of the last call.
  [[nodiscard]] const Linearization& linearization() const { return system_.linearization(); }
  [[nodiscard]] const solvers::LinearSolver& solver() const { return system_.solver(); }

 private:
  Horizon horizon_;
  ValueReader reader_;
  FactorizedLinearization system_;
  Eigen::VectorXd z_bar_;
};

/// dΨ of a trajectory from the assembled H̄ and a solver of your choice: one AssembledAdjoint.
///
///     gradient(horizon, trajectory, objective, solver_factory("umfpack"))
///
/// @throws NumericalFailure as AssembledAdjoint::gradient
[[nodiscard]] Gradient gradient(const Horizon& horizon, const Trajectory& trajectory,
                                const Objective& objective, const solvers::SolverFactory& factory);

using solvers::solver_factory;

}  // namespace hbar
