#pragma once

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/owned.h"
#include "hbar/solvers/linear/cached_solver.h"

namespace hbar {

/// How a periodic orbit is searched for.
struct PeriodicOptions {
  /// Periods simulated before Newton's method takes over, to start it near the limit cycle; ≥ 1
  int warm_up = 3;
  /// q_N − q_0, rad or length; empty means zero. A wheel that turns once has 2π here.       [dof]
  Eigen::VectorXd advance = {};
  /// For the whole trajectory; tol is per stage, as in SimulationOptions.
  solvers::NewtonOptions newton = {};
  solvers::SolverFactory solver = nullptr;  ///< for H̄; null means KLU
};

/// A periodic orbit, q_N = q_0 + advance and q̇_N = q̇_0: one period of N steps.
struct PeriodicOrbit {
  Trajectory trajectory;         ///< inputs.q0 and qdot0 lie on the orbit
  solvers::NewtonReport newton;  ///< of the whole trajectory
  double mismatch =
      0.0;  ///< max |(q_N, q̇_N) − (q_0, q̇_0)| of the last simulated period, as a start
};

/// Finds periodic orbits: Newton's method on ḡ(q̄, p, u, q_N − advance, q̇_N) = 0 for the whole
/// trajectory at once. H̄ then has blocks above its diagonal (periodic_matrix), which takes a
/// general sparse solver; the period is the horizon's N·h, as for a mechanism driven by controls.
///
/// BDF2 starts every period with its SDIRK2 step. Holds its workspace for one horizon and belongs
/// to one thread at a time.
class PeriodicSolver {
 public:
  /// @throws InvalidInput if warm_up or the size of advance violates PeriodicOptions
  explicit PeriodicSolver(const Horizon& horizon, PeriodicOptions options = {});
  ~PeriodicSolver();
  PeriodicSolver(PeriodicSolver&&) noexcept;
  PeriodicSolver& operator=(PeriodicSolver&&) noexcept;

  /// @param guess  p and u of the orbit; q0 and qdot0 start the first period
  /// @throws NumericalFailure if a simulated period or Newton's method does not converge (the
  ///         message says where, how far it got and what to try), or H̄ is singular: the orbit is
  ///         not isolated, as for a mechanism without damping or drive
  /// @throws InvalidInput as Simulator::rollout, and if exponential coordinates end in a
  ///         chart other than they start in
  [[nodiscard]] PeriodicOrbit solve(const Inputs& guess);

  /// Ψ and its derivative with respect to p and u along an orbit, with the initial state following:
  /// H̄ᵀ z̄ = ȳ with the periodic H̄, then ∂Ψ/∂(p, u) − z̄ᵀ ∂ḡ/∂(p, u).
  ///
  /// @param orbit  found by solve()
  /// @returns  with q0 and qdot0 zero: they are not inputs
  /// @throws NumericalFailure if H̄ is singular
  [[nodiscard]] Gradient gradient(const Trajectory& orbit, const Objective& objective);

  /// The solver of the last call.
  [[nodiscard]] const solvers::LinearSolver& solver() const;

 private:
  struct Workspace;
  Owned<Workspace> work_;
};

/// One orbit: PeriodicSolver::solve.
[[nodiscard]] PeriodicOrbit solve_periodic(const Horizon& horizon, const Inputs& guess,
                                           const PeriodicOptions& options = {});

}  // namespace hbar
