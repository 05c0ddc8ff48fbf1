#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "hbar/solvers/linear/linear_solver.h"
#include "tests/support/message_of.h"

namespace hbar::solvers::testing {

/// A matrix of numbers in [-1, 1], the same for the same seed.
inline Eigen::MatrixXd random_dense(int rows, int columns, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd result(rows, columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      result(i, j) = uniform(engine);
    }
  }
  return result;
}

/// The entries of a dense matrix that are not zero.
inline SparseMatrix sparse_of(const Eigen::MatrixXd& dense) {
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  return A;
}

/// Unsymmetric with a strong diagonal and about `per_column` further entries in each column.
inline SparseMatrix random_sparse(int size, int per_column, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::uniform_int_distribution<int> any_row(0, size - 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < size; ++j) {
    entries.emplace_back(j, j, 3.0 + uniform(engine));
    for (int k = 0; k < per_column; ++k) {
      entries.emplace_back(any_row(engine), j, uniform(engine));
    }
  }
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// Block lower triangular: dense diagonal blocks, each coupled to the two blocks before it.
inline SparseMatrix random_block_lower(const std::vector<int>& sizes, unsigned seed) {
  std::vector<int> begin = {0};
  for (const int size : sizes) {
    begin.push_back(begin.back() + size);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    for (std::size_t a = b < 2 ? 0 : b - 2; a <= b; ++a) {
      const Eigen::MatrixXd block =
          random_dense(sizes[b], sizes[a], seed + static_cast<unsigned>(97 * b + a));
      for (int i = 0; i < sizes[b]; ++i) {
        for (int j = 0; j < sizes[a]; ++j) {
          const double diagonal = a == b && i == j ? 3.0 : 0.0;
          entries.emplace_back(begin[b] + i, begin[a] + j, block(i, j) + diagonal);
        }
      }
    }
  }
  SparseMatrix A(begin.back(), begin.back());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

using hbar::testing::message_of;

}  // namespace hbar::solvers::testing
