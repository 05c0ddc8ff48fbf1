#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hbar::solvers {

/// Some consecutive entries of one column of a sparse matrix, rows ascending. Rows without a gap,
/// as in matrices of dense blocks, are treated as a dense vector.
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
    for (int k = 0; k < count; ++k) {
      y[rows[k]] -= values[k] * factor;
    }
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
    for (int k = 0; k < count; ++k) {
      sum += values[k] * y[rows[k]];
    }
    return sum;
  }

  /// Raises `largest` and `sum` of the column's rows by the magnitudes of its entries.
  ///
  /// @param largest, sum  beginnings of dense vectors with all the column's rows
  /// @returns  sum of all magnitudes; not finite if an entry is not
  double measure(double* largest, double* sum) const {
    if (has_no_gap()) {
      const auto magnitudes = Eigen::Map<const Eigen::ArrayXd>(values, count).abs();
      Eigen::Map<Eigen::ArrayXd> rows_largest(largest + rows[0], count);
      rows_largest = rows_largest.max(magnitudes);
      Eigen::Map<Eigen::ArrayXd>(sum + rows[0], count) += magnitudes;
      return magnitudes.sum();
    }
    double total = 0.0;
    for (int k = 0; k < count; ++k) {
      const double magnitude = std::abs(values[k]);
      largest[rows[k]] = std::max(largest[rows[k]], magnitude);
      sum[rows[k]] += magnitude;
      total += magnitude;
    }
    return total;
  }

 private:
  [[nodiscard]] bool has_no_gap() const {
    return count > 0 && rows[count - 1] - rows[0] == count - 1;
  }
};

}  // namespace hbar::solvers
