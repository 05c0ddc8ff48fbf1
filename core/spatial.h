#pragma once

#include <Eigen/Geometry>

#include "hbar/core/scalar.h"

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
[[nodiscard]] RigidTransform<S> operator*(const RigidTransform<S>& X_AB,
                                          const RigidTransform<S>& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p};
}

/// X_BA from X_AB.
template <Scalar S>
[[nodiscard]] RigidTransform<S> inverse(const RigidTransform<S>& X_AB) {
  return {X_AB.R.transpose(), -(X_AB.R.transpose() * X_AB.p)};
}

/// The 6-vector of two 3-vectors, rotation part first.
template <Scalar S>
[[nodiscard]] Vector6<S> spatial(const Vector3<S>& rotation, const Vector3<S>& translation) {
  Vector6<S> six;
  six << rotation, translation;
  return six;
}

/// V × W on twists: the rate of W carried along by V (formulation "ad").
template <Scalar S>
[[nodiscard]] Vector6<S> cross_twist(const Vector6<S>& V, const Vector6<S>& W) {
  const Vector3<S> w = V.template head<3>();
  const Vector3<S> u = V.template tail<3>();
  const Vector3<S> a = W.template head<3>();
  const Vector3<S> b = W.template tail<3>();
  return spatial<S>(w.cross(a), w.cross(b) + u.cross(a));
}

/// V ×* F on wrenches, −ad(V)ᵀ: (V × W)·F = −W·(V ×* F).
template <Scalar S>
[[nodiscard]] Vector6<S> cross_wrench(const Vector6<S>& V, const Vector6<S>& F) {
  const Vector3<S> w = V.template head<3>();
  const Vector3<S> u = V.template tail<3>();
  const Vector3<S> torque = F.template head<3>();
  const Vector3<S> force = F.template tail<3>();
  return spatial<S>(w.cross(torque) + u.cross(force), w.cross(force));
}

/// [v], the matrix of v × .
template <Scalar S>
[[nodiscard]] Matrix3<S> skew(const Vector3<S>& v) {
  Matrix3<S> m;
  m << S(0.0), -v.z(), v.y(), v.z(), S(0.0), -v.x(), -v.y(), v.x(), S(0.0);
  return m;
}

/// Twist, at the origin of A and in A, of a unit rotation about `axis` (in B) through B's origin.
template <Scalar S>
[[nodiscard]] Vector6<S> rotation_twist(const RigidTransform<S>& X_AB, const Vector3<S>& axis) {
  const Vector3<S> axis_A = X_AB.R * axis;
  return spatial<S>(axis_A, X_AB.p.cross(axis_A));
}

/// Twist, at the origin of A and in A, of a unit translation along `axis` (in B).
template <Scalar S>
[[nodiscard]] Vector6<S> translation_twist(const Matrix3<S>& R_AB, const Vector3<S>& axis) {
  return spatial<S>(Vector3<S>::Zero(), R_AB * axis);
}

}  // namespace hbar
