#pragma once

#include <algorithm>
#include <string>

#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::solvers {

/// Bytes that the factors of a band may take: 8 GiB. Wider bands are refused.
inline constexpr double kMaxBandBytes = 8.0 * 1024.0 * 1024.0 * 1024.0;

/// How far from the diagonal a matrix has entries.
struct Band {
  int lower = 0;  ///< diagonals below the main one
  int upper = 0;  ///< and above

  [[nodiscard]] int width() const { return std::max(lower, upper); }
};

/// @param A  square, compressed, row indices ascending: each column's first and last entry tell
[[nodiscard]] inline Band band_of(const SparseMatrix& A) {
  Band band;
  for (int j = 0; j < A.cols(); ++j) {
    const int begin = A.outerIndexPtr()[j];
    const int end = A.outerIndexPtr()[j + 1];
    if (begin == end) {
      continue;
    }
    band.upper = std::max(band.upper, j - A.innerIndexPtr()[begin]);
    band.lower = std::max(band.lower, A.innerIndexPtr()[end - 1] - j);
  }
  return band;
}

/// @param solver  its name
/// @param bytes   bytes that the factors would take
/// @throws InvalidInput if there are more than kMaxBandBytes
inline void refuse_wide_band(const std::string& solver, const SparseMatrix& A, double bytes) {
  if (bytes <= kMaxBandBytes) {
    return;
  }
  throw InvalidInput(concat(solver, ": analyze: the band of the ", A.rows(), " x ", A.cols(),
                            " matrix would take ", bytes, " bytes; allowed: ", kMaxBandBytes,
                            "; use klu or umfpack for such a matrix"));
}

}  // namespace hbar::solvers
