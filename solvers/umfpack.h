#pragma once

#include <memory>

#include "hbar/solvers/linear_solver.h"

namespace hbar::solvers {

/// SuiteSparse UMFPACK (GPL; target hbar::umfpack): multifrontal sparse LU for general matrices.
/// Its own iterative refinement is off: LinearSolver refines where that is needed.
[[nodiscard]] std::unique_ptr<LinearSolver> make_umfpack();

}  // namespace hbar::solvers
