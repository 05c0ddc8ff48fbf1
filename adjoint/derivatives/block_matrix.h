#pragma once

#include <utility>
#include <vector>

#include "hbar/core/parameters/sparsity.h"
#include "hbar/solvers/linear/linear_solver.h"

namespace hbar {

/// A matrix of zeros with a given pattern.
///
/// @param counts  entries per column                                           [columns]
/// @param fill    fill(column, rows) writes the row indices of a column, ascending
template <typename Fill>
[[nodiscard]] solvers::SparseMatrix zeros_with_pattern(Eigen::Index rows,
                                                       const Eigen::VectorXi& counts,
                                                       const Fill& fill) {
  solvers::SparseMatrix matrix(rows, counts.size());
  matrix.resizeNonZeros(counts.sum());
  int* outer = matrix.outerIndexPtr();
  outer[0] = 0;
  for (Eigen::Index c = 0; c < counts.size(); ++c) {
    outer[c + 1] = outer[c] + counts[c];
    fill(static_cast<int>(c), matrix.innerIndexPtr() + outer[c]);
  }
  matrix.coeffs().setZero();
  return matrix;
}

/// A compressed sparse column matrix made of equally sized blocks of one pattern. The pattern is
/// laid out once; after that only values change.
class BlockMatrix {
 public:
  BlockMatrix() = default;

  /// @param block_rows, block_columns  counts of blocks
  /// @param blocks   (row, column) of each; set_block refers to them by this order; within a column
  ///                 ascending by row
  /// @param pattern  of one block, by column                                     [dof]
  BlockMatrix(int block_rows, int block_columns, const std::vector<std::pair<int, int>>& blocks,
              const std::vector<std::vector<int>>& pattern);

  /// Overwrites the values of a block.
  ///
  /// @param index  position in the constructor's list
  /// @param dense  entries outside the pattern are not read                    [dof x dof]
  void set_block(std::size_t index, const Eigen::Ref<const Eigen::MatrixXd>& dense);

  [[nodiscard]] const solvers::SparseMatrix& matrix() const { return matrix_; }

 private:
  struct Place {
    int column = 0;  // block column
    int rank = 0;    // among the blocks of its column
  };

  solvers::SparseMatrix matrix_;
  std::vector<Place> places_;
  std::vector<std::vector<int>> pattern_;
};

}  // namespace hbar
