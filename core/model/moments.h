#pragma once

#include <Eigen/Core>

namespace hbar {

/// Share of the largest moment by which it may exceed the sum of the other two: numbers of a few
/// digits do where a body is flat.
inline constexpr double kRoundedMoments = 1e-6;

/// By how much the largest principal moment exceeds the sum of the other two, as a share of it. No
/// body's does; a flat one's is equal. Rounding (1e-12) does not count: 0.
///
/// @param moments  positive  [3]
[[nodiscard]] inline double excess_of_moments(const Eigen::Vector3d& moments) {
  const double largest = moments.maxCoeff();
  const double excess = (2.0 * largest - moments.sum()) / largest;
  return excess > 1e-12 ? excess : 0.0;
}

}  // namespace hbar
