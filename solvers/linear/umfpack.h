#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse UMFPACK (GPL; target hbar::umfpack): multifrontal sparse LU for general matrices.
/// Its own iterative refinement is off: LinearSolver refines where that is needed.
///
/// @param options  orderings: by default UMFPACK chooses between amd, which also prefers pivots on
///                 the diagonal, and colamd; further natural and metis. Rows and columns that need
///                 no elimination come first in any case. 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_umfpack(const SolverOptions& options = {});

/// Adds it to the solvers that are found by their names. Including "hbar/umfpack.h" calls this.
///
/// @returns true
bool register_umfpack();

}  // namespace hbar::solvers
