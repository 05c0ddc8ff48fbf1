#pragma once

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/solvers/linear/solver_options.h"

namespace hbar {

/// H̄ of a trajectory that closes: q₀ and q̇₀ are the last stage's q_N − advance and q̇_N, so that
/// what depends on them fills blocks above the diagonal, in the last block columns:
/// H̄ + ∂ḡ/∂q₀ ∂q_N/∂q̄ + ∂ḡ/∂q̇₀ ∂q̇_N/∂q̄.
///
/// @param linearization  of that trajectory
/// @returns  of a pattern that depends on the timeline and the switched charts alone    [m x m]
/// @throws InvalidInput if exponential coordinates end in another chart than they start
[[nodiscard]] solvers::SparseMatrix periodic_matrix(const Model& model,
                                                    const Trajectory& trajectory,
                                                    const Linearization& linearization);

/// Its structure and blocks.
[[nodiscard]] solvers::SolverOptions periodic_options(const Linearization& linearization);

/// @throws InvalidInput naming the joint if exponential coordinates end in another chart than they
///         start
void refuse_changed_charts(const Model& model, const Trajectory& trajectory);

}  // namespace hbar
