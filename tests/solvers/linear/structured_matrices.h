#pragma once

#include <numeric>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers::testing {

inline int rows_of(const std::vector<int>& sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), 0);
}

/// The block (b, a) of a matrix of blocks of these sizes, appended to its entries.
inline void append_block(const std::vector<int>& sizes, std::size_t b, std::size_t a,
                         const Eigen::MatrixXd& block,
                         std::vector<Eigen::Triplet<double>>& entries) {
  const int row = std::accumulate(sizes.begin(), sizes.begin() + static_cast<int>(b), 0);
  const int column = std::accumulate(sizes.begin(), sizes.begin() + static_cast<int>(a), 0);
  for (int j = 0; j < block.cols(); ++j) {
    for (int i = 0; i < block.rows(); ++i) {
      entries.emplace_back(row + i, column + j, block(i, j));
    }
  }
}

/// Block lower triangular, and blocks above the diagonal in the last two block columns.
inline SparseMatrix random_periodic(const std::vector<int>& sizes, unsigned seed) {
  SparseMatrix A = random_block_lower(sizes, seed);
  std::vector<Eigen::Triplet<double>> entries;
  const std::size_t blocks = sizes.size();
  for (std::size_t b = 0; b + 2 < blocks && b < 2; ++b) {
    for (std::size_t a = blocks - 2 + b; a < blocks; ++a) {
      append_block(sizes, b, a,
                   random_dense(sizes[b], sizes[a], seed + static_cast<unsigned>(7 * a + b)),
                   entries);
    }
  }
  SparseMatrix corner(A.rows(), A.cols());
  corner.setFromTriplets(entries.begin(), entries.end());
  A += corner;
  A.makeCompressed();
  return A;
}

/// JᵀJ + 1 of a block lower triangular J: symmetric, definite, each block coupled to two on each
/// side. Products keep their zeros, so that the pattern depends on the sizes alone.
inline SparseMatrix random_definite(const std::vector<int>& sizes, unsigned seed) {
  const SparseMatrix J = random_block_lower(sizes, seed);
  SparseMatrix identity(J.rows(), J.cols());
  identity.setIdentity();
  SparseMatrix A = SparseMatrix(J.transpose()) * J + identity;
  // Rounding may differ above and below the diagonal.
  A = (0.5 * (A + SparseMatrix(A.transpose()))).eval();
  A.makeCompressed();
  return A;
}

/// [[P, Bᵀ], [B, −Q]] in time order: each block is P and −Q of one time, coupled by a block lower
/// triangular B; as many positive as negative eigenvalues where all sizes are even. Of a block, the
/// first half are unknowns and the second multipliers.
inline SparseMatrix random_quasi_definite(const std::vector<int>& sizes, unsigned seed) {
  SparseMatrix A = random_definite(sizes, seed);
  std::vector<int> is_multiplier;
  for (const int size : sizes) {
    for (int i = 0; i < size; ++i) {
      is_multiplier.push_back(2 * i >= size + size % 2 ? 1 : 0);
    }
  }
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      const int multipliers = is_multiplier[static_cast<std::size_t>(entry.row())] +
                              is_multiplier[static_cast<std::size_t>(j)];
      // Of a definite matrix the diagonal blocks are definite; one is negated.
      if (multipliers == 2) {
        entry.valueRef() = -entry.value();
      }
    }
  }
  return A;
}

/// A matrix of a structure.
inline SparseMatrix random_of(Structure structure, const std::vector<int>& sizes, unsigned seed) {
  switch (structure) {
    case Structure::kGeneral:
      return random_sparse(rows_of(sizes), 3, seed);
    case Structure::kBlockTriangular:
      return random_block_lower(sizes, seed);
    case Structure::kPeriodic:
      return random_periodic(sizes, seed);
    case Structure::kDefinite:
      return random_definite(sizes, seed);
    case Structure::kQuasiDefinite:
      return random_quasi_definite(sizes, seed);
  }
  return {};
}

}  // namespace hbar::solvers::testing
