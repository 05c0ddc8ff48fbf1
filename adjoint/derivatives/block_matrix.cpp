#include "hbar/adjoint/derivatives/block_matrix.h"

namespace hbar {

BlockMatrix::BlockMatrix(int block_rows, int block_columns,
                         const std::vector<std::pair<int, int>>& blocks,
                         const std::vector<std::vector<int>>& pattern)
    : pattern_(pattern) {
  const auto n = static_cast<int>(pattern.size());
  std::vector<std::vector<int>> rows_of_column(static_cast<std::size_t>(block_columns));
  for (const auto& [row, column] : blocks) {
    auto& rows = rows_of_column[static_cast<std::size_t>(column)];
    places_.push_back({column, static_cast<int>(rows.size())});
    rows.push_back(row);
  }
  Eigen::VectorXi counts(block_columns * n);
  for (int j = 0; j < block_columns; ++j) {
    for (int c = 0; c < n; ++c) {
      counts[j * n + c] = static_cast<int>(rows_of_column[static_cast<std::size_t>(j)].size() *
                                           pattern[static_cast<std::size_t>(c)].size());
    }
  }
  matrix_ = zeros_with_pattern(block_rows * n, counts, [&](int column, int* rows) {
    for (const int row : rows_of_column[static_cast<std::size_t>(column / n)]) {
      for (const int l : pattern[static_cast<std::size_t>(column % n)]) {
        *rows++ = row * n + l;
      }
    }
  });
}

void BlockMatrix::set_block(std::size_t index, const Eigen::Ref<const Eigen::MatrixXd>& dense) {
  const Place& place = places_[index];
  const auto n = static_cast<int>(pattern_.size());
  for (int c = 0; c < n; ++c) {
    const std::vector<int>& rows = pattern_[static_cast<std::size_t>(c)];
    double* value = matrix_.valuePtr() + matrix_.outerIndexPtr()[place.column * n + c] +
                    place.rank * static_cast<int>(rows.size());
    for (const int l : rows) {
      *value++ = dense(l, c);
    }
  }
}

}  // namespace hbar
