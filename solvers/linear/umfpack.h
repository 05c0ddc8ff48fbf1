#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse UMFPACK (GPL; target hbar::umfpack): multifrontal sparse LU for general matrices.
/// Its own iterative refinement is off: LinearSolver refines where needed.
///
/// @param options  orderings: by default UMFPACK chooses between amd, which also prefers pivots on
///                 the diagonal, and colamd; also natural and metis. Rows and columns that need no
///                 elimination always come first. 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_umfpack(const SolverOptions& options = {});

/// Adds it to the solvers found by name. Including "hbar/umfpack.h" calls this.
///
/// @returns true
bool register_umfpack();

}  // namespace hbar::solvers
