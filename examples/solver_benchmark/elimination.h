#pragma once

#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::solver_benchmark {

/// The pattern of L + Lᵀ that eliminating the rows in the given order leaves, when pivots stay on
/// the diagonal and nothing cancels: what an LU of the symmetrised pattern A + Aᵀ fills in.
///
/// Walks the elimination tree: each column of L is that of A below the diagonal, joined with those
/// of its children (J. W. H. Liu, "The role of elimination trees in sparse factorization", 1990).
///
/// @param A  square; its diagonal counts as full                              [m x m]
/// @returns  the row indices, ascending, of each column of L, the diagonal first
[[nodiscard]] std::vector<std::vector<int>> symbolic_factor(const solvers::SparseMatrix& A);

/// The order that approximate minimum degree takes for A + Aᵀ: row `order[k]` is eliminated k-th.
[[nodiscard]] std::vector<int> minimum_degree_order(const solvers::SparseMatrix& A);

/// Rows and columns of A in another order.
///
/// @param order  row order[k] of A becomes row k
[[nodiscard]] solvers::SparseMatrix reordered(const solvers::SparseMatrix& A,
                                              const std::vector<int>& order);

}  // namespace hbar::solver_benchmark
