#pragma once

#include "hbar/core/base/scalar.h"

namespace hbar {

/// A signed distance φ given by data, in a body's frame: the surface of a triangle mesh in a
/// contact. Negative inside. Immutable, and safe to share between threads.
class DistanceField {
 public:
  /// φ and its first two derivatives at a point.
  struct Sample {
    double distance = 0.0;                               ///< φ, length
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< ∇φ                    [3]
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   ///< ∇²φ, 1/length         [3 x 3]
  };

  DistanceField() = default;
  DistanceField(const DistanceField&) = delete;
  DistanceField& operator=(const DistanceField&) = delete;
  virtual ~DistanceField() = default;

  /// A number that is < 0 only where φ < 0 and that, outside, does not exceed the distance to the
  /// surface: cheap far away, φ itself nearby.
  ///
  /// @param x  a point in the body's frame, length                                   [3]
  [[nodiscard]] virtual double lower_bound(const Eigen::Vector3d& x) const = 0;

  /// φ with its derivatives; φ is twice continuously differentiable.
  [[nodiscard]] virtual Sample sample(const Eigen::Vector3d& x) const = 0;

  /// Derivative of the Hessian along a direction.                                [3 x 3]
  [[nodiscard]] virtual Eigen::Matrix3d hessian_slope(const Eigen::Vector3d& x,
                                                      const Eigen::Vector3d& direction) const = 0;

  /// Whether another field is known to be the same everywhere: by default, if it is this object.
  [[nodiscard]] virtual bool same_as(const DistanceField& other) const { return this == &other; }
};

}  // namespace hbar
