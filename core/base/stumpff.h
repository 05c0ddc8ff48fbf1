#pragma once

#include <array>
#include <cmath>

#include "hbar/core/base/scalar.h"

namespace hbar {

/// The Stumpff functions c_n(s) = Σ_k (−s)^k / (2k + n)!  for n = 0 … 7, with s = θ².
///
/// c_0 = cos θ, c_1 = sin θ / θ, c_2 = (1 − cos θ)/θ², c_3 = (θ − sin θ)/θ³, … Each is an entire
/// function, so that formulas built from them have no singularity at θ = 0. They satisfy
/// c_n = 1/n! − s c_{n+2} and, without any division, dc_n/ds = (n c_{n+2} − c_{n+1}) / 2. Accurate
/// to rounding for 0 ≤ s ≤ (2π)².
///
/// Source: K. Stumpff, Himmelsmechanik I (1959), §41; the derivative follows from the series.
template <Scalar S>
[[nodiscard]] std::array<S, 8> stumpff(const S& s) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  constexpr std::array<double, 8> kInverseFactorial = {
      1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0};
  std::array<S, 8> c;
  // Downward recursion from a series where that is accurate, upward from sin and cos elsewhere.
  constexpr double kSeriesLimit = 9.0;
  if (value_of(s) < kSeriesLimit) {
    constexpr int kTerms = 14;
    S even(1.0);
    S odd(1.0);
    for (int k = kTerms; k >= 1; --k) {
      even = 1.0 - s * even * (1.0 / ((2.0 * k + 5.0) * (2.0 * k + 6.0)));
      odd = 1.0 - s * odd * (1.0 / ((2.0 * k + 6.0) * (2.0 * k + 7.0)));
    }
    c[6] = even * kInverseFactorial[6];
    c[7] = odd * kInverseFactorial[7];
    for (std::size_t n = 6; n-- > 0;) {
      c[n] = kInverseFactorial[n] - s * c[n + 2];
    }
  } else {
    const S theta = sqrt(s);
    c[0] = cos(theta);
    c[1] = sin(theta) / theta;
    for (std::size_t n = 0; n < 6; ++n) {
      c[n + 2] = (kInverseFactorial[n] - c[n]) / s;
    }
  }
  return c;
}

}  // namespace hbar
