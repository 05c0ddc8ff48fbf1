#pragma once

#include <array>

#include "hbar/core/base/spatial.h"

namespace hbar {

/// exp([r]): the rotation by ‖r‖ about r.                                        [3 x 3]
template <Scalar S>
[[nodiscard]] Matrix3<S> exp_rotation(const Vector3<S>& r);

/// Rotation by `angle` (rad) about the unit vector `axis`.                       [3 x 3]
template <Scalar S>
[[nodiscard]] Matrix3<S> axis_rotation(const Eigen::Vector3d& axis, const S& angle);

/// Right Jacobian of exp: exp([r])ᵀ d exp([r]) = [J_r(r) dr].                    [3 x 3]
template <Scalar S>
[[nodiscard]] Matrix3<S> right_jacobian(const Vector3<S>& r);

/// J_r(r)⁻¹ for ‖r‖ < 2π, exact at r = 0: ∂ log(R exp([x]))/∂x at x = 0, r = log R.  [3 x 3]
template <Scalar S>
[[nodiscard]] Matrix3<S> right_jacobian_inverse(const Vector3<S>& r);

/// The right Jacobian of exp and everything needed to differentiate S(r) ṙ = J_r(r) ṙ twice.
///
/// With T[x, y] = Σ_k ∂(J_r x)/∂r_k y_k, the derivative of J_r(r) x along y. Exact to rounding for
/// all ‖r‖ < 2π, r = 0 included (functions of stumpff.h).
template <Scalar S>
struct ExponentialRates {
  Matrix3<S> J;                     ///< J_r(r)                              [3 x 3]
  Vector3<S> J_dot_rate;            ///< J̇_r ṙ = T[ṙ, ṙ]                     [3]
  Matrix3<S> d_velocity_dr;         ///< ∂(J_r ṙ)/∂r = T[ṙ, ·]               [3 x 3]
  Matrix3<S> d_acceleration_dr;     ///< ∂(J_r r̈ + J̇_r ṙ)/∂r                 [3 x 3]
  Matrix3<S> d_acceleration_drate;  ///< ∂(J̇_r ṙ)/∂ṙ                         [3 x 3]
  std::array<Matrix3<S>, 3> dJ_dr;  ///< ∂J_r/∂r_k                           3 of [3 x 3]
};

/// @param r         exponential coordinates, rad          [3]
/// @param rate      ṙ, rad/time                           [3]
/// @param rate_dot  r̈, rad/time²                          [3]
template <Scalar S>
[[nodiscard]] ExponentialRates<S> exponential_rates(const Vector3<S>& r, const Vector3<S>& rate,
                                                    const Vector3<S>& rate_dot);

/// Rotation vector r with exp([r]) = R and ‖r‖ ≤ π, rad.                         [3]
[[nodiscard]] Eigen::Vector3d log_rotation(const Eigen::Matrix3d& R);
/// The same with the derivative along the direction carried by R; ‖r‖ < π.          [3]
template <std::same_as<Dual> S>
[[nodiscard]] Vector3<S> log_rotation(const Matrix3<S>& R);

}  // namespace hbar
