#pragma once

#include <Eigen/Core>
#include <vector>

namespace hbar::scene {

/// An inertia in its principal axes.
struct PrincipalAxes {
  Eigen::Vector3d moments;  ///< ascending                                             [3]
  Eigen::Matrix3d axes;     ///< columns: right-handed, of unit length, in the old axes  [3 x 3]
};

/// Principal axes of a symmetric inertia, ascending moments first. The largest entry of each of the
/// first two axes is positive; the third axis completes a right-handed frame.
///
/// @param inertia  symmetric, mass·length²  [3 x 3]
[[nodiscard]] PrincipalAxes principal_axes(const Eigen::Matrix3d& inertia);

/// The symmetric matrix of the six numbers xx xy xz yy yz zz.  [3 x 3]
///
/// @throws InvalidInput if there are not six
[[nodiscard]] Eigen::Matrix3d symmetric_matrix(const std::vector<double>& entries);

}  // namespace hbar::scene
