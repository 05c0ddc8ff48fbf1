#pragma once

#include <Eigen/Geometry>

#include "hbar/core/base/scalar.h"

namespace hbar {

/// Pose of a frame B in a frame A: x_A = R x_B + p.
template <Scalar S>
struct RigidTransform {
  Matrix3<S> R = Matrix3<S>::Identity();  ///< axes of B in A        [3 x 3]
  Vector3<S> p = Vector3<S>::Zero();      ///< origin of B in A, length [3]

  friend bool operator==(const RigidTransform& a, const RigidTransform& b) {
    return a.R == b.R && a.p == b.p;
  }
};

/// X_AC = X_AB X_BC.
template <Scalar S>
[[nodiscard]] inline RigidTransform<S> operator*(const RigidTransform<S>& X_AB,
                                                 const RigidTransform<S>& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p};
}

/// X_BA from X_AB.
template <Scalar S>
[[nodiscard]] inline RigidTransform<S> inverse(const RigidTransform<S>& X_AB) {
  return {X_AB.R.transpose(), -(X_AB.R.transpose() * X_AB.p)};
}

// The functions of 6-vectors below work entry by entry: Eigen's vectorised loads would stall on
// entries that have just been stored.

/// The 6-vector of two 3-vectors, rotation part first.
template <Scalar S>
[[nodiscard]] inline Vector6<S> spatial(const Vector3<S>& rotation, const Vector3<S>& translation) {
  Vector6<S> six;
  for (int i = 0; i < 3; ++i) {
    six[i] = rotation[i];
    six[3 + i] = translation[i];
  }
  return six;
}

/// a + b + …
template <Scalar S, typename... More>
[[nodiscard]] inline Vector6<S> sum(const Vector6<S>& a, const More&... more) {
  Vector6<S> out;
  for (int i = 0; i < 6; ++i) {
    out[i] = (a[i] + ... + more[i]);
  }
  return out;
}

/// Power F·V of a wrench on a twist.
template <Scalar S>
[[nodiscard]] inline S power(const Vector6<S>& F, const Vector6<S>& V) {
  S out = F[0] * V[0];
  for (int i = 1; i < 6; ++i) {
    out += F[i] * V[i];
  }
  return out;
}

/// V × W = ad(V) W on twists: the rate of W carried along by V.
template <Scalar S>
[[nodiscard]] inline Vector6<S> cross_twist(const Vector6<S>& V, const Vector6<S>& W) {
  Vector6<S> out;
  out[0] = V[1] * W[2] - V[2] * W[1];
  out[1] = V[2] * W[0] - V[0] * W[2];
  out[2] = V[0] * W[1] - V[1] * W[0];
  out[3] = V[1] * W[5] - V[2] * W[4] + V[4] * W[2] - V[5] * W[1];
  out[4] = V[2] * W[3] - V[0] * W[5] + V[5] * W[0] - V[3] * W[2];
  out[5] = V[0] * W[4] - V[1] * W[3] + V[3] * W[1] - V[4] * W[0];
  return out;
}

/// V ×* F on wrenches, −ad(V)ᵀ: (V × W)·F = −W·(V ×* F).
template <Scalar S>
[[nodiscard]] inline Vector6<S> cross_wrench(const Vector6<S>& V, const Vector6<S>& F) {
  Vector6<S> out;
  out[0] = V[1] * F[2] - V[2] * F[1] + V[4] * F[5] - V[5] * F[4];
  out[1] = V[2] * F[0] - V[0] * F[2] + V[5] * F[3] - V[3] * F[5];
  out[2] = V[0] * F[1] - V[1] * F[0] + V[3] * F[4] - V[4] * F[3];
  out[3] = V[1] * F[5] - V[2] * F[4];
  out[4] = V[2] * F[3] - V[0] * F[5];
  out[5] = V[0] * F[4] - V[1] * F[3];
  return out;
}

/// [v], the matrix of v × .
template <Scalar S>
[[nodiscard]] inline Matrix3<S> skew(const Vector3<S>& v) {
  Matrix3<S> m;
  m << S(0.0), -v.z(), v.y(), v.z(), S(0.0), -v.x(), -v.y(), v.x(), S(0.0);
  return m;
}

/// Twist, at the origin of A and in A, of a unit rotation about `axis` (in B) through B's origin.
template <Scalar S>
[[nodiscard]] inline Vector6<S> rotation_twist(const RigidTransform<S>& X_AB,
                                               const Vector3<S>& axis) {
  const Vector3<S> axis_A = X_AB.R * axis;
  return spatial<S>(axis_A, X_AB.p.cross(axis_A));
}

/// Twist, at the origin of A and in A, of a unit translation along `axis` (in B).
template <Scalar S>
[[nodiscard]] inline Vector6<S> translation_twist(const Matrix3<S>& R_AB, const Vector3<S>& axis) {
  return spatial<S>(Vector3<S>::Zero(), R_AB * axis);
}

}  // namespace hbar
