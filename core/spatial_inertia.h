#pragma once

#include "hbar/core/spatial.h"

namespace hbar {

/// Mass distribution of a rigid body in a frame A: ten numbers, additive over bodies.
template <Scalar S>
struct SpatialInertia {
  S mass = S(0.0);
  Vector3<S> first = Vector3<S>::Zero();   ///< ∫ x dm, mass·length            [3]
  Matrix3<S> second = Matrix3<S>::Zero();  ///< ∫ x xᵀ dm, mass·length²        [3 x 3]

  SpatialInertia& operator+=(const SpatialInertia& other) {
    mass += other.mass;
    first += other.first;
    second += other.second;
    return *this;
  }

  /// Momentum I V = (angular momentum about A's origin; linear momentum).    [6]
  [[nodiscard]] Vector6<S> operator*(const Vector6<S>& V) const {
    const Vector3<S> w = V.template head<3>();
    const Vector3<S> u = V.template tail<3>();
    return spatial<S>(second.trace() * w - second * w + first.cross(u), mass * u - first.cross(w));
  }
};

/// The mass distribution of a body with mass m and principal moments I, seen from frame A.
///
/// @param X_AB  body frame (centre of mass, principal axes) in A
template <Scalar S>
[[nodiscard]] SpatialInertia<S> body_inertia(const S& mass, const Vector3<S>& moments,
                                             const RigidTransform<S>& X_AB) {
  const Vector3<S> spread = Vector3<S>::Constant(0.5 * moments.sum()) - moments;
  return {mass, mass * X_AB.p,
          X_AB.R * spread.asDiagonal() * X_AB.R.transpose() + mass * X_AB.p * X_AB.p.transpose()};
}

/// The same mass distribution seen from A instead of B.
template <Scalar S>
[[nodiscard]] SpatialInertia<S> transformed(const RigidTransform<S>& X_AB,
                                            const SpatialInertia<S>& I_B) {
  const Vector3<S> turned = X_AB.R * I_B.first;
  const Matrix3<S> half = (turned + (0.5 * I_B.mass) * X_AB.p) * X_AB.p.transpose();
  const Matrix3<S> RS = X_AB.R * I_B.second;
  return {I_B.mass, turned + I_B.mass * X_AB.p, RS * X_AB.R.transpose() + half + half.transpose()};
}

/// The velocity-dependent operator of formulation §2,
/// B W = −I (V × W) + W ×* (I V) + V ×* (I W), in closed form.
///
/// With I = (m, h, Σ) and V = (w; u) the terms in W's translation cancel, and what is left is
/// B W = (C ω; 2 ω × p) with C = −2([w] Σ + [h] [u]) and p the linear momentum. Additive over
/// bodies.
template <Scalar S>
struct CoriolisOperator {
  Matrix3<S> C = Matrix3<S>::Zero();         ///< angular to angular block     [3 x 3]
  Vector3<S> momentum = Vector3<S>::Zero();  ///< linear momentum              [3]

  CoriolisOperator& operator+=(const CoriolisOperator& other) {
    C += other.C;
    momentum += other.momentum;
    return *this;
  }

  /// B W, a wrench.                                                            [6]
  [[nodiscard]] Vector6<S> operator*(const Vector6<S>& W) const {
    const Vector3<S> w = W.template head<3>();
    return spatial<S>(C * w, 2.0 * w.cross(momentum));
  }

  /// Angular half of Bᵀ W; the other half is zero.                             [3]
  [[nodiscard]] Vector3<S> transposed_times(const Vector6<S>& W) const {
    const Vector3<S> w = W.template head<3>();
    const Vector3<S> u = W.template tail<3>();
    return C.transpose() * w + 2.0 * momentum.cross(u);
  }
};

/// @param I         mass distribution
/// @param V         twist in the same frame
/// @param momentum  I V
template <Scalar S>
[[nodiscard]] CoriolisOperator<S> coriolis_operator(const SpatialInertia<S>& I, const Vector6<S>& V,
                                                    const Vector6<S>& momentum) {
  const Vector3<S> w = V.template head<3>();
  const Vector3<S> u = V.template tail<3>();
  CoriolisOperator<S> B;
  for (int j = 0; j < 3; ++j) {
    B.C.col(j) = -2.0 * w.cross(Vector3<S>(I.second.col(j)));
  }
  // [h][u] = u hᵀ − (h·u) 1.
  B.C -= 2.0 * u * I.first.transpose();
  B.C.diagonal().array() += 2.0 * I.first.dot(u);
  B.momentum = momentum.template tail<3>();
  return B;
}

}  // namespace hbar
