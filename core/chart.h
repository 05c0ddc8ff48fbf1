#pragma once

#include <numbers>

#include "hbar/core/scalar.h"

namespace hbar {

/// Exponential coordinates leave their chart at a step's end where ‖r‖ exceeds this (rad): well
/// before the singularity at 2π, and late enough that a rotation to and fro stays in one chart.
inline constexpr double kChartLimit = 1.5 * std::numbers::pi;

/// The same rotation in the other chart, φ(r) = (1 − 2π/‖r‖) r. φ is its own inverse for
/// 0 < ‖r‖ < 2π.                                                                          [3]
[[nodiscard]] inline Eigen::Vector3d change_chart(const Eigen::Vector3d& r) {
  return (1.0 - 2.0 * std::numbers::pi / r.norm()) * r;
}

/// Dφ(r): maps rates so that the angular velocity is unchanged.                          [3 x 3]
[[nodiscard]] inline Eigen::Matrix3d chart_derivative(const Eigen::Vector3d& r) {
  const double norm = r.norm();
  const Eigen::Vector3d n = r / norm;
  const double k = 2.0 * std::numbers::pi / norm;
  return (1.0 - k) * Eigen::Matrix3d::Identity() + k * n * n.transpose();
}

/// ∂(Dφ(r) rate)/∂r.                                                                     [3 x 3]
[[nodiscard]] inline Eigen::Matrix3d chart_second_derivative(const Eigen::Vector3d& r,
                                                             const Eigen::Vector3d& rate) {
  const double norm = r.norm();
  const Eigen::Vector3d n = r / norm;
  const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - n * n.transpose();
  const Eigen::Vector3d across = P * rate;
  return 2.0 * std::numbers::pi / (norm * norm) *
         (across * n.transpose() + n.dot(rate) * P + n * across.transpose());
}

}  // namespace hbar
