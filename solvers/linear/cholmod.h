#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// SuiteSparse CHOLMOD (LGPL): simplicial LLᵀ of a symmetric positive definite matrix, of which
/// only one triangle is read. No BLAS, little overhead: good if there is little fill.
///
/// factorize() throws NumericalFailure naming the row at which the matrix stops being positive
/// definite.
///
/// @param options  orderings: natural, amd (the default), metis, nested; 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_llt(const SolverOptions& options = {});

/// CHOLMOD's supernodal LLᵀ (GPL): dense blocks by BLAS, for factors with much fill; otherwise like
/// make_cholmod_llt. CHOLMOD before version 4, if built with OpenMP, starts up to four threads of
/// its own; only the environment variable OMP_THREAD_LIMIT=1 prevents that.
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_supernodal(
    const SolverOptions& options = {});

/// CHOLMOD (LGPL): simplicial LDLᵀ of a symmetric quasi-definite matrix, of which only one triangle
/// is read. There is no pivoting: any order suits a quasi-definite matrix, while other indefinite
/// matrices may run into a pivot that is too small and are then refused as singular. The inertia is
/// that of D.
///
/// @param options  orderings: natural (the default, as such systems come in time order), amd,
///                 metis, nested; 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_ldlt(const SolverOptions& options = {});

/// CHOLMOD (LGPL): any square A by simplicial LLᵀ of A Aᵀ, whose condition number is the square of
/// A's: half the digits are lost. Refinement recovers them up to a condition number of about 1e7;
/// beyond that, the matrix is refused as singular, or the solution for its residual.
///
/// @param options  orderings: natural, amd, colamd (the default), metis, nested, all of A Aᵀ;
///                 32- or 64-bit indices
/// @throws InvalidInput for another ordering
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_normal(const SolverOptions& options = {});

}  // namespace hbar::solvers
