#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Eigen's supernodal sparse LU (MPL; after SuperLU), with partial pivoting; needs no library but
/// Eigen.
///
/// Orderings: natural, amd, colamd (the default).
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_eigen_sparse_lu(const SolverOptions& options = {});

}  // namespace hbar::solvers
