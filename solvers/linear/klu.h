#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse KLU (LGPL): sparse LU by block triangular form, without BLAS; bitwise reproducible
/// on every machine. A second factorize() keeps the pivot order of the first while the pivots stay
/// acceptable, and chooses a new one otherwise.
///
/// @param options  orderings: amd (the default) and colamd of the blocks of the block triangular
///                 form, natural without that form; 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_klu(const SolverOptions& options = {});

}  // namespace hbar::solvers
