#pragma once

#include "hbar/core/base/spatial.h"

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
    const S trace = second(0, 0) + second(1, 1) + second(2, 2);
    Vector6<S> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out[i] = trace * V[i] - second(i, 0) * V[0] - second(i, 1) * V[1] - second(i, 2) * V[2] +
               first[j] * V[3 + k] - first[k] * V[3 + j];
      out[3 + i] = mass * V[3 + i] - first[j] * V[k] + first[k] * V[j];
    }
    return out;
  }
};

/// The mass distribution of a body with mass m and principal moments I, seen from frame A.
///
/// @param X_AB  body frame (centre of mass, principal axes) in A
template <Scalar S>
[[nodiscard]] inline SpatialInertia<S> body_inertia(const S& mass, const Vector3<S>& moments,
                                                    const RigidTransform<S>& X_AB) {
  const Vector3<S> spread = Vector3<S>::Constant(0.5 * moments.sum()) - moments;
  return {mass, mass * X_AB.p,
          X_AB.R * spread.asDiagonal() * X_AB.R.transpose() + mass * X_AB.p * X_AB.p.transpose()};
}

/// The same mass distribution seen from A instead of B.
template <Scalar S>
[[nodiscard]] inline SpatialInertia<S> transformed(const RigidTransform<S>& X_AB,
                                                   const SpatialInertia<S>& I_B) {
  const Vector3<S> turned = X_AB.R * I_B.first;
  const Vector3<S> half = turned + (0.5 * I_B.mass) * X_AB.p;
  const Matrix3<S> RS = X_AB.R * I_B.second;
  SpatialInertia<S> I_A;
  I_A.mass = I_B.mass;
  I_A.first = turned + I_B.mass * X_AB.p;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      const S entry = RS.row(i).dot(X_AB.R.row(j)) + half[i] * X_AB.p[j] + half[j] * X_AB.p[i];
      I_A.second(i, j) = entry;
      I_A.second(j, i) = entry;
    }
  }
  return I_A;
}

/// The velocity-dependent operator of doc/notation.md, B W = −I (V × W) + W ×* (I V) + V ×* (I W),
/// in closed form.
///
/// With I = (m, h, Σ) and V = (w; u) the terms in W's translation cancel, which leaves
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
    Vector6<S> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out[i] = C(i, 0) * W[0] + C(i, 1) * W[1] + C(i, 2) * W[2];
      out[3 + i] = 2.0 * (W[j] * momentum[k] - W[k] * momentum[j]);
    }
    return out;
  }

  /// Angular half of Bᵀ W; the other half is zero.                             [3]
  [[nodiscard]] Vector3<S> transposed_times(const Vector6<S>& W) const {
    Vector3<S> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out[i] = C(0, i) * W[0] + C(1, i) * W[1] + C(2, i) * W[2] +
               2.0 * (momentum[j] * W[3 + k] - momentum[k] * W[3 + j]);
    }
    return out;
  }
};

/// @param I         mass distribution
/// @param V         twist in the same frame
/// @param momentum  I V
template <Scalar S>
[[nodiscard]] inline CoriolisOperator<S> coriolis_operator(const SpatialInertia<S>& I,
                                                           const Vector6<S>& V,
                                                           const Vector6<S>& momentum) {
  // [h][u] = u hᵀ − (h·u) 1.
  const S along = I.first[0] * V[3] + I.first[1] * V[4] + I.first[2] * V[5];
  CoriolisOperator<S> B;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      const S turned = V[j] * I.second(k, c) - V[k] * I.second(j, c);
      B.C(i, c) = -2.0 * (turned + V[3 + i] * I.first[c]);
    }
    B.C(c, c) += 2.0 * along;
  }
  B.momentum = momentum.template tail<3>();
  return B;
}

}  // namespace hbar
