#pragma once

#include "hbar/core/base/spatial_inertia.h"

namespace hbar::testing {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Ad(X_AB): moves a twist from B to A.
[[nodiscard]] inline Matrix6d adjoint(const RigidTransform<double>& X_AB) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = X_AB.R;
  Ad.bottomLeftCorner<3, 3>() = skew<double>(X_AB.p) * X_AB.R;
  Ad.bottomRightCorner<3, 3>() = X_AB.R;
  return Ad;
}

/// ad(V), the matrix of V × on twists.
[[nodiscard]] inline Matrix6d twist_cross_matrix(const Vector6<double>& V) {
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = skew<double>(V.head<3>());
  ad.bottomLeftCorner<3, 3>() = skew<double>(V.tail<3>());
  ad.bottomRightCorner<3, 3>() = skew<double>(V.head<3>());
  return ad;
}

/// The inertia of a body as a matrix in a frame A, by the transformation law of inertias.
///
/// @param X_AB  body frame (centre of mass, principal axes) in A
[[nodiscard]] inline Matrix6d inertia_matrix(double mass, const Eigen::Vector3d& moments,
                                             const RigidTransform<double>& X_AB) {
  Matrix6d I_B = Matrix6d::Zero();
  I_B.diagonal() << moments, mass, mass, mass;
  const Matrix6d Ad_BA = adjoint(inverse(X_AB));
  return Ad_BA.transpose() * I_B * Ad_BA;
}

}  // namespace hbar::testing
