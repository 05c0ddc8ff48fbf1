#pragma once

#include <string_view>

#include "hbar/adjoint/systems/optimality_matrix.h"

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

/// A linear system of a trajectory.
struct TrajectorySystem : AssembledSystem {
  SystemKind kind = SystemKind::kAdjoint;
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
