#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace hbar {

/// A vector of length 1 in the direction of v, whose length may be any finite number, also one
/// whose square is not; zero if v is zero. What has length 1 to rounding is returned as it is.
[[nodiscard]] inline Eigen::Vector3d unit_vector(const Eigen::Vector3d& v) {
  if (std::abs(v.squaredNorm() - 1.0) <= 8.0 * std::numeric_limits<double>::epsilon()) {
    return v;
  }
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d scaled = v / largest;
  return scaled / scaled.norm();
}

}  // namespace hbar
