#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparseQR (GPL): multifrontal sparse QR of any square matrix, its rows and columns scaled.
/// More fill and work than LU, but backward stable without pivoting. Its indices are always 64 bits
/// wide, regardless of the options; it allocates in every solve.
///
/// factorize() throws NumericalFailure naming the column that depends on those eliminated before
/// it, and, since QR has no pivot rows, the row where that column is largest.
///
/// @param options  orderings: natural, amd, colamd (the default), metis, all of AᵀA
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_spqr(const SolverOptions& options = {});

}  // namespace hbar::solvers
