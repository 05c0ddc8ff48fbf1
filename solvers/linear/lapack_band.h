#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// LAPACK's LU of a band matrix (dgbtrf): scalar bandwidths, partial pivoting, so that the upper
/// band grows by the width of the lower one. As fast as the BLAS it uses.
///
/// @throws InvalidInput if ordering is not kDefault or kNatural
///
/// analyze() throws InvalidInput if the factors would take more than kMaxBandBytes (band.h).
[[nodiscard]] std::unique_ptr<LinearSolver> make_lapack_band(const SolverOptions& options = {});

}  // namespace hbar::solvers
