#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "hbar/core/base/scalar.h"

namespace hbar {

/// Exponential coordinates leave their chart at a step's end where ‖r‖ exceeds this (rad): well
/// before the singularity at 2π, and late enough that small oscillations stay in one chart.
inline constexpr double kChartLimit = 1.5 * std::numbers::pi;

/// The same rotation in the other chart, φ(r) = (1 − 2π/‖r‖) r. φ is its own inverse for
/// 0 < ‖r‖ < 2π.                                                                          [3]
template <Scalar S = double>
[[nodiscard]] inline Vector3<S> change_chart(const std::type_identity_t<Vector3<S>>& r) {
  using std::sqrt;
  return (1.0 - 2.0 * std::numbers::pi / sqrt(r.dot(r))) * r;
}

/// Dφ(r): maps rates so that the angular velocity is unchanged.                          [3 x 3]
template <Scalar S = double>
[[nodiscard]] inline Matrix3<S> chart_derivative(const std::type_identity_t<Vector3<S>>& r) {
  using std::sqrt;
  const S norm = sqrt(r.dot(r));
  const Vector3<S> n = r / norm;
  const S k = 2.0 * std::numbers::pi / norm;
  return (1.0 - k) * Matrix3<S>::Identity() + k * n * n.transpose();
}

/// ∂(Dφ(r) rate)/∂r.                                                                     [3 x 3]
template <Scalar S = double>
[[nodiscard]] inline Matrix3<S> chart_second_derivative(
    const std::type_identity_t<Vector3<S>>& r, const std::type_identity_t<Vector3<S>>& rate) {
  using std::sqrt;
  const S norm = sqrt(r.dot(r));
  const Vector3<S> n = r / norm;
  const Matrix3<S> P = Matrix3<S>::Identity() - n * n.transpose();
  const Vector3<S> across = P * rate;
  return 2.0 * std::numbers::pi / (norm * norm) *
         (across * n.transpose() + n.dot(rate) * P + n * across.transpose());
}

}  // namespace hbar
