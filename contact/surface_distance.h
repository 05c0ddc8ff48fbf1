#pragma once

#include <algorithm>

#include "hbar/core/geometry/shape.h"
#include "hbar/core/model/contact.h"

namespace hbar {

/// Signed distance of a surface at a point, all in the surface's own frame.
template <Scalar S>
struct SurfaceSample {
  S d;                  ///< φ, length; negative inside
  Vector3<S> gradient;  ///< ∇φ: n, except for a distance given by data             [3]
  Vector3<S> n;         ///< contact normal, unit                                   [3]
  Matrix3<S> dn_dx;     ///< ∂n/∂x, 1/length                                        [3 x 3]
};

/// How a sample changes with one size of the shape, at a fixed point.
template <Scalar S>
struct SizeRate {
  S d;           ///< ∂φ/∂size
  Vector3<S> n;  ///< ∂n/∂size                                                       [3]
};

/// The surface side of one contact, with parameters applied.
///
/// Exact, inside and outside. Where the distance has kinks (medial planes of a cuboid, a ball's
/// centre) the derivatives are those of one side. Cheap to copy; borrows a DistanceField.
template <Scalar S>
class SurfaceDistance {
 public:
  /// @param shape  of the body that OwnShape refers to; otherwise not read
  /// @param sizes  current sizes of that shape, as sizes_of lists them               [3]
  SurfaceDistance(const ContactSurface& surface, const Shape& shape, const Vector3<S>& sizes);

  /// A lower bound of φ: positive only if x is at least that far outside; equals φ wherever φ ≤ 0.
  [[nodiscard]] double lower_bound(const Eigen::Vector3d& x) const;
  /// Whether a point at lower_bound d is in contact: d < 0, on a plane also d = 0.
  [[nodiscard]] bool touches(double d) const {
    return d < 0.0 || (kind_ == Kind::kPlane && d == 0.0);
  }

  [[nodiscard]] SurfaceSample<S> sample(const Vector3<S>& x) const;

  /// @param k  index of a size of the shape
  [[nodiscard]] SizeRate<S> by_size(const Vector3<S>& x, int k) const;

  /// Number of sizes that the distance depends on: those of the shape, or none.
  [[nodiscard]] int size_count() const;
  [[nodiscard]] bool is_plane() const { return kind_ == Kind::kPlane; }

 private:
  enum class Kind { kPlane, kCuboid, kSphere, kCylinder, kTube, kCapsule, kField };

  Kind kind_ = Kind::kPlane;
  Vector3<S> sizes_;
  Eigen::Vector3d values_;  // of sizes_
  Eigen::Vector3d point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  const DistanceField* field_ = nullptr;
};

// Inline: called for every point and every cluster of points.
template <Scalar S>
inline double SurfaceDistance<S>::lower_bound(const Eigen::Vector3d& x) const {
  switch (kind_) {
    case Kind::kPlane:
      return normal_.dot(x - point_);
    case Kind::kCuboid:
      return std::max({std::abs(x[0]) - 0.5 * values_[0], std::abs(x[1]) - 0.5 * values_[1],
                       std::abs(x[2]) - 0.5 * values_[2]});
    case Kind::kSphere:
      return x.norm() - values_[0];
    case Kind::kCylinder:
    case Kind::kTube: {
      const double side = std::sqrt(x[0] * x[0] + x[1] * x[1]) - values_[0];
      const double end = std::abs(x[2]) - 0.5 * values_[1];
      return kind_ == Kind::kTube && end <= 0.0 ? side : std::max(side, end);
    }
    case Kind::kCapsule: {
      const double beyond = std::max(0.0, std::abs(x[2]) - 0.5 * values_[1]);
      return std::sqrt(x[0] * x[0] + x[1] * x[1] + beyond * beyond) - values_[0];
    }
    case Kind::kField:
      return field_->lower_bound(x);
  }
  return 0.0;
}

}  // namespace hbar
