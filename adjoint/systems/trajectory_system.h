#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/solvers/linear/solver_options.h"

namespace hbar {

/// The linear systems that trajectory problems lead to.
enum class SystemKind {
  /// H̄ = ∂ḡ/∂q̄ (20): gradients and sensitivities. Block lower triangular.
  kAdjoint,
  /// H̄ of a trajectory that closes, q_N = q_0 and q̇_N = q̇_0: blocks above the diagonal.
  kPeriodic,
  /// SᵀS + λI of following a motion with forces on every coordinate, all of the trajectory unknown:
  /// S = [√w E; √ρ D H̄] with E = ∂(what is followed)/∂q̄. Definite, block banded.
  kGaussNewton,
  /// The optimality conditions of following a motion with the motors, states, controls and
  /// multipliers unknown: quasi-definite, in time order.
  kKkt
};

/// "adjoint", "periodic", "gauss_newton", "kkt".
[[nodiscard]] std::string_view name_of(SystemKind kind);
/// @throws InvalidInput naming the systems there are
[[nodiscard]] SystemKind find_system_kind(std::string_view name);

/// Weights of the two optimisation systems. Rows of ḡ are scaled to a largest entry of 1 (D).
struct SystemOptions {
  double tracking = 1.0;    ///< w, on what is followed: the variables v, or q where there are none
  double forces = 1.0;      ///< ρ, kGaussNewton: on the forces that act besides the motors
  double effort = 1e-2;     ///< kKkt: on controls
  double damping = 1e-6;    ///< λ > 0, on every unknown of the optimisation
  double slack = 1e-8;      ///< kKkt: −slack·I is the multipliers' diagonal block, > 0
  bool parameters = false;  ///< kKkt: design parameters are unknowns, too (last: a border)
};

/// A linear system with what a solver and a reader of its messages need to know of it.
struct TrajectorySystem {
  SystemKind kind = SystemKind::kAdjoint;
  solvers::SparseMatrix A;         ///<                                            [m x m]
  Eigen::VectorXd b;               ///< a right-hand side, see assemble_system      [m]
  solvers::SolverOptions options;  ///< structure and blocks, in time order
  std::function<std::string(int)> name_of_unknown;  ///< "stage 3 (t = 0.04), coordinate elbow"
};

/// Assembles a system along a trajectory.
///
/// b is −∂ḡ/∂q̇₀·1 for kAdjoint and kPeriodic (how the motion answers to a push at its start), and
/// the negative gradient for a reference that lies 1 (rad or length) off for the other two.
///
/// @param trajectory  whole, of this horizon
/// @throws InvalidInput for weights that are not as SystemOptions says, or a kPeriodic trajectory
///         whose exponential coordinates end in another chart than they start
[[nodiscard]] TrajectorySystem assemble_system(SystemKind kind, const Horizon& horizon,
                                               const Trajectory& trajectory,
                                               const SystemOptions& options = {});

}  // namespace hbar
