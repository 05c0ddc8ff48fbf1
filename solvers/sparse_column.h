#pragma once

#include <Eigen/Core>

namespace hbar::solvers {

/// Some neighbouring entries of one column of a sparse matrix: rows ascend. Rows without a gap, as
/// in matrices of dense blocks, are treated as the dense vector they are.
struct SparseColumn {
  const int* rows = nullptr;       ///< row of each entry  [count]
  const double* values = nullptr;  ///< its value          [count]
  int count = 0;                   ///< entries

  /// y ← y − column · factor.
  ///
  /// @param factor  any number
  /// @param y       begin of a dense vector with all the column's rows
  void subtract_from(double* y, double factor) const {
    if (has_no_gap()) {
      Eigen::Map<Eigen::VectorXd>(y + rows[0], count) -=
          factor * Eigen::Map<const Eigen::VectorXd>(values, count);
      return;
    }
    for (int k = 0; k < count; ++k) y[rows[k]] -= values[k] * factor;
  }

  /// Inner product of the column with a dense vector.
  ///
  /// @param y  begin of a dense vector with all the column's rows
  [[nodiscard]] double dot(const double* y) const {
    if (has_no_gap()) {
      return Eigen::Map<const Eigen::VectorXd>(values, count)
          .dot(Eigen::Map<const Eigen::VectorXd>(y + rows[0], count));
    }
    double sum = 0.0;
    for (int k = 0; k < count; ++k) sum += values[k] * y[rows[k]];
    return sum;
  }

 private:
  [[nodiscard]] bool has_no_gap() const {
    return count > 0 && rows[count - 1] - rows[0] == count - 1;
  }
};

}  // namespace hbar::solvers
