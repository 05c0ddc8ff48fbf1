#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse CHOLMOD (LGPL): simplicial LLᵀ of a symmetric, positive definite matrix, of which
/// one triangle alone is read. No BLAS, little overhead: good where there is little fill.
///
/// factorize() throws NumericalFailure naming the row at which the matrix stops being positive
/// definite.
///
/// @param options  orderings: natural, amd (the default), metis, nested; 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_llt(const SolverOptions& options = {});

/// CHOLMOD's supernodal LLᵀ (GPL): dense blocks by BLAS, for factors with much fill; otherwise like
/// make_cholmod_llt. CHOLMOD before version 4, where it was built with OpenMP, starts up to four
/// threads of its own; the environment's OMP_THREAD_LIMIT=1 alone stops it.
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_supernodal(
    const SolverOptions& options = {});

/// CHOLMOD (LGPL): simplicial LDLᵀ of a symmetric, quasi-definite matrix, of which one triangle
/// alone is read. There is no pivoting: any order suits a quasi-definite matrix, while another
/// indefinite one may meet a pivot that is too small, and is refused as singular. The inertia is
/// that of D.
///
/// @param options  orderings: natural (the default: such systems come in time order), amd, metis,
///                 nested; 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_ldlt(const SolverOptions& options = {});

/// CHOLMOD (LGPL): any square A by simplicial LLᵀ of A Aᵀ, whose condition number is that of A
/// squared: half the digits are lost. Refinement mends that up to a condition number of about 1e7;
/// beyond, the matrix is refused as singular, or the solution for its residual.
///
/// @param options  orderings: natural, amd, colamd (the default), metis, nested, all of A Aᵀ; 32-
/// or
///                 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_normal(const SolverOptions& options = {});

}  // namespace hbar::solvers
