#pragma once

#include <memory>

#include "hbar/solvers/solver_options.h"

namespace hbar::solvers {

/// SuiteSparseQR (GPL): multifrontal sparse QR of any square matrix. Slower than LU and with more
/// fill, but backward stable for every matrix, whatever its scales. Its indices are always 64 bits
/// wide.
///
/// Orderings: natural, amd, colamd (the default), metis.
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_spqr(const SolverOptions& options = {});

}  // namespace hbar::solvers
