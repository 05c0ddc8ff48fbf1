#pragma once

#include "hbar/core/base/scalar.h"
#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::solvers {

/// ‖b − A x‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞), summed with more digits than a double has: how far, against
/// their norms, A and b must be moved for x to be exact (Rigal & Gaches 1967). Aᵀ stands for A
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

/// maxᵢ |b − A x|ᵢ / (|A| |x| + |b|)ᵢ, otherwise like normwise_backward_error: how far, against its
/// own size, each entry of A and b must be moved for x to be exact (Oettli & Prager 1964). A row
/// 0 / 0 counts 0.
///
/// @param A       square                  [n x n]
/// @param system  which system x solves
/// @param x       a solution              [n]
/// @param b       its right-hand side     [n]
/// @throws InvalidInput if the shapes disagree
[[nodiscard]] double componentwise_backward_error(const SparseMatrix& A, System system,
                                                  const VectorView<double>& x,
                                                  const VectorView<double>& b);

/// Solves A x = b to the last digits: iterative refinement with residuals and a solution of twice a
/// double's digits, until it no longer converges. Right to about a double's rounding while the
/// condition number of A is below 1e14 or so; a reference for the errors of others.
///
/// @param solver  that has factorised A
/// @param A       square              [n x n]
/// @param b       right-hand side     [n]
/// @returns       solution            [n]
/// @throws InvalidInput if the shapes disagree
/// @throws NumericalFailure as solver.solve()
[[nodiscard]] Eigen::VectorXd refined_solution(LinearSolver& solver, const SparseMatrix& A,
                                               const VectorView<double>& b);

/// A lower bound on ‖A‖₁ ‖A⁻¹‖₁ that is seldom less than a third of it, for about five solutions
/// with A and Aᵀ (N. J. Higham, FORTRAN codes for estimating the one-norm of a real or complex
/// matrix, ACM Trans. Math. Software 14, 1988).
///
/// @param solver  that has factorised A
/// @param A       square              [n x n]
/// @throws InvalidInput if the shapes disagree
/// @throws NumericalFailure as solver.solve()
[[nodiscard]] double estimate_condition(LinearSolver& solver, const SparseMatrix& A);

}  // namespace hbar::solvers
