#pragma once

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/solvers/linear/cached_solver.h"

namespace hbar {

class Timeline;

/// The linear system of a trajectory, ready to solve: matrices from Linearizer, H̄ factorised by
/// any solver, its pattern analysed once per timeline (in practice: once).
class FactorizedLinearization {
 public:
  /// @param factory  of the solver for H̄; null means block substitution
  explicit FactorizedLinearization(const Horizon& horizon, solvers::SolverFactory factory = nullptr)
      : horizon_(horizon), linearizer_(horizon), solver_(std::move(factory)) {}

  /// @param trajectory  complete, of this horizon
  /// @returns  valid until the next call
  /// @throws NumericalFailure naming the stage and the coordinate where H̄ is singular
  const Linearization& update(const Trajectory& trajectory);

  /// Of the last update.
  [[nodiscard]] const Linearization& linearization() const { return *linearization_; }
  [[nodiscard]] solvers::LinearSolver& solver() { return solver_.solver(); }
  [[nodiscard]] const solvers::LinearSolver& solver() const { return solver_.solver(); }

 private:
  Horizon horizon_;
  Linearizer linearizer_;
  solvers::CachedSolver solver_;
  const Linearization* linearization_ = nullptr;
};

/// Names the unknowns of H̄ for LinearSolver::name_unknowns: "stage 3 (t = 0.04), coordinate elbow".
[[nodiscard]] std::function<std::string(int)> stage_names(const Horizon& horizon,
                                                          const Timeline& timeline);

}  // namespace hbar
