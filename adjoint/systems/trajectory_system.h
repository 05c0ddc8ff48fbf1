#pragma once

#include <string_view>

#include "hbar/adjoint/systems/optimality_matrix.h"

namespace hbar {

/// The linear systems that trajectory problems lead to.
enum class SystemKind {
  /// H̄ = ∂ḡ/∂q̄ (20): gradients and sensitivities. Block lower triangular.
  kAdjoint,
  /// H̄ of a periodic orbit, q_N = q_0 and q̇_N = q̇_0: blocks above the diagonal.
  kPeriodic,
  /// SᵀS + λI of tracking a motion with forces on every coordinate, the whole trajectory unknown:
  /// S = [√w E; √ρ D H̄] with E = ∂(what is tracked)/∂q̄. Definite, block banded.
  kGaussNewton,
  /// The optimality conditions of tracking a motion with the motors; states, controls and
  /// multipliers are unknown. Quasi-definite, in time order.
  kKkt
};

/// "adjoint", "periodic", "gauss_newton", "kkt".
[[nodiscard]] std::string_view name_of(SystemKind kind);
/// @throws InvalidInput listing the known systems
[[nodiscard]] SystemKind find_system_kind(std::string_view name);

/// A linear system of a trajectory.
struct TrajectorySystem : AssembledSystem {
  SystemKind kind = SystemKind::kAdjoint;
};

/// Assembles a system along a trajectory.
///
/// b is −∂ḡ/∂q̇₀·1 for kAdjoint and kPeriodic (the response to a push at the start); for the other
/// two it is the negative gradient for a reference that is 1 (rad or length) away.
///
/// @param trajectory  complete, of this horizon
/// @throws InvalidInput for weights that violate SystemOptions, or a kPeriodic trajectory whose
///         exponential coordinates end in a chart other than they start in
[[nodiscard]] TrajectorySystem assemble_system(SystemKind kind, const Horizon& horizon,
                                               const Trajectory& trajectory,
                                               const SystemOptions& options = {});

}  // namespace hbar
