#pragma once

#include <memory>

#include "hbar/solvers/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse UMFPACK (GPL; target hbar::umfpack): multifrontal sparse LU for general matrices.
/// Its own iterative refinement is off: LinearSolver refines where that is needed.
[[nodiscard]] std::unique_ptr<LinearSolver> make_umfpack(const SolverOptions& options = {});

}  // namespace hbar::solvers
