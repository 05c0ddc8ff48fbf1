#pragma once

#include <memory>

#include "hbar/solvers/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse CHOLMOD (LGPL): simplicial LLᵀ of a symmetric, positive definite matrix, whose lower
/// triangle alone is read. No BLAS, little fill: good for bands and trees.
///
/// Orderings: natural, amd (the default), metis, nested.
///
/// @throws InvalidInput for an ordering that is not among these
/// factorize() throws NumericalFailure naming the row at which the matrix stops being positive
/// definite.
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_llt(const SolverOptions& options = {});

/// CHOLMOD's supernodal LLᵀ (GPL): dense blocks by BLAS, for factors with much fill; otherwise like
/// make_cholmod_llt.
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_supernodal(
    const SolverOptions& options = {});

/// CHOLMOD (LGPL): simplicial LDLᵀ of a symmetric, quasi-definite matrix, whose lower triangle
/// alone is read. There is no pivoting: every order works for a quasi-definite matrix, while
/// another indefinite one may meet a pivot that is too small, which is refused as singular. The
/// inertia is that of D.
///
/// Orderings: natural (the default: such systems come in time order), amd, metis, nested.
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_ldlt(const SolverOptions& options = {});

/// CHOLMOD (LGPL): any square A, by LLᵀ of A Aᵀ. The condition number is squared: of 16 digits as
/// many are lost as the matrix has twice. Refinement mends that while the condition of A stays
/// below about 1e8; beyond, A Aᵀ is no longer positive definite or the residual is too large, and
/// the matrix or the solution is refused.
///
/// Orderings: natural, amd, colamd (the default), metis, nested; all but natural look at A Aᵀ.
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_normal(const SolverOptions& options = {});

}  // namespace hbar::solvers
