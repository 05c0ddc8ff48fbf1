#pragma once

#include "hbar/core/base/scalar.h"
#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::solvers {

/// ‖b − A x‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞), summed in more than double precision: how far, relative to
/// their norms, A and b must be perturbed for x to be exact (Rigal & Gaches 1967). Aᵀ stands for A
/// where `system` says so. 0 where the quotient is 0 / 0.
///
/// @param A       square                  [n x n]
/// @param system  which system x solves
/// @param x       a solution              [n]
/// @param b       its right-hand side     [n]
/// @throws InvalidInput if the shapes disagree
[[nodiscard]] double normwise_backward_error(const SparseMatrix& A, System system,
                                             const VectorView<double>& x,
                                             const VectorView<double>& b);

/// maxᵢ |b − A x|ᵢ / (|A| |x| + |b|)ᵢ, otherwise like normwise_backward_error: how far, relative to
/// its own size, each entry of A and b must be perturbed for x to be exact (Oettli & Prager 1964).
/// A row 0 / 0 counts as 0.
///
/// @param A       square                  [n x n]
/// @param system  which system x solves
/// @param x       a solution              [n]
/// @param b       its right-hand side     [n]
/// @throws InvalidInput if the shapes disagree
[[nodiscard]] double componentwise_backward_error(const SparseMatrix& A, System system,
                                                  const VectorView<double>& x,
                                                  const VectorView<double>& b);

/// Solves A x = b to full precision: iterative refinement with residuals and solution in about
/// twice double precision, until it no longer converges. Accurate to about double rounding while
/// the condition number of A is below about 1e14; a reference for the errors of other solvers.
///
/// @param solver  that has factorised A
/// @param A       square              [n x n]
/// @param b       right-hand side     [n]
/// @returns       solution            [n]
/// @throws InvalidInput if the shapes disagree
/// @throws NumericalFailure as solver.solve()
[[nodiscard]] Eigen::VectorXd refined_solution(LinearSolver& solver, const SparseMatrix& A,
                                               const VectorView<double>& b);

/// A lower bound on ‖A‖₁ ‖A⁻¹‖₁ that is rarely below a third of it, at the cost of about five
/// solves with A and Aᵀ (N. J. Higham, FORTRAN codes for estimating the one-norm of a real or
/// complex matrix, ACM Trans. Math. Software 14, 1988).
///
/// @param solver  that has factorised A
/// @param A       square              [n x n]
/// @throws InvalidInput if the shapes disagree
/// @throws NumericalFailure as solver.solve()
[[nodiscard]] double estimate_condition(LinearSolver& solver, const SparseMatrix& A);

}  // namespace hbar::solvers
