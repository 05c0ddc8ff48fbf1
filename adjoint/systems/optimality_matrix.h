#pragma once

#include "hbar/adjoint/systems/trajectory_system.h"

namespace hbar {

/// Fills A, b and options with kGaussNewton's SᵀS + λI and √w Eᵀ·1.
///
/// @param linearization  of the trajectory
void fill_gauss_newton(const Horizon& horizon, const Trajectory& trajectory,
                       const Linearization& linearization, const SystemOptions& weights,
                       TrajectorySystem& out);

/// Fills A, b, options and names with kKkt's matrix, stage by stage the coordinates, the controls
/// of a step that begins there, and the multipliers of the stage's residual:
///
///     [ w EᵀE + λI                H̄ᵀD        ]
///     [              (r + λ) I    ∂ḡ/∂uᵀ D    ]      r: effort, D: row scales of H̄
///     [ D H̄          D ∂ḡ/∂u     −slack I    ]
///
/// and with weights.parameters a last block of design parameters, λI and D ∂ḡ/∂p.
void fill_kkt(const Horizon& horizon, const Trajectory& trajectory,
              const Linearization& linearization, const SystemOptions& weights,
              TrajectorySystem& out);

}  // namespace hbar
