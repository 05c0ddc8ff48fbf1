#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <type_traits>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"

// Shared code of the SuiteSparse solvers. SuiteSparse's headers are included only in their .cpp
// files.
namespace hbar::solvers::suitesparse {

/// SuiteSparse's wide index: SuiteSparse_long in version 5, int64_t from 7 on.
using WideIndex = std::int64_t;

/// The column starts and row indices of a matrix in the width that a library expects: the matrix's
/// own arrays for `int`, a copy for WideIndex. SuiteSparse takes them as pointers to non-const and
/// does not write to them.
template <typename Index>
class IndexArrays {
 public:
  /// @param A  compressed; its arrays must stay in place
  void assign(const SparseMatrix& A) {
    const int* columns = A.outerIndexPtr();
    const int* rows = A.innerIndexPtr();
    if constexpr (std::is_same_v<Index, int>) {
      columns_ = const_cast<int*>(columns);
      rows_ = const_cast<int*>(rows);
    } else {
      kept_columns_.assign(columns, columns + A.cols() + 1);
      kept_rows_.assign(rows, rows + A.nonZeros());
      columns_ = kept_columns_.data();
      rows_ = kept_rows_.data();
    }
  }

  /// Where each column begins  [columns + 1]
  [[nodiscard]] Index* columns() const { return columns_; }
  /// Row of each entry  [entries]
  [[nodiscard]] Index* rows() const { return rows_; }

 private:
  Index* columns_ = nullptr;
  Index* rows_ = nullptr;
  std::vector<Index> kept_columns_;
  std::vector<Index> kept_rows_;
};

/// A permutation as the base class expects it.
///
/// @param permutation  in the library's width  [n]
/// @param narrow       the same, as int        [n]
template <typename Index>
void narrow_indices(const Index* permutation, std::vector<int>& narrow) {
  std::transform(permutation, permutation + narrow.size(), narrow.begin(),
                 [](Index index) { return static_cast<int>(index); });
}

/// A solver belongs to one thread; newer versions use OpenMP where they find it.
template <typename Common>
void use_one_thread(Common& common) {
  if constexpr (requires { common.nthreads_max; }) {
    common.nthreads_max = 1;
  }
}

/// A lock held during an analysis that may call METIS, which seeds the process-wide random
/// generator and draws from it: orderings of concurrent analyses would depend on timing.
[[nodiscard]] inline std::unique_lock<std::mutex> lock_metis(Ordering ordering) {
  static std::mutex mutex;
  const bool draws = ordering == Ordering::kMetis || ordering == Ordering::kNested;
  return draws ? std::unique_lock(mutex) : std::unique_lock<std::mutex>();
}

}  // namespace hbar::solvers::suitesparse
