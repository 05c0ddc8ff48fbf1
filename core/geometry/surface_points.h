#pragma once

#include <array>

#include "hbar/core/geometry/shape.h"

namespace hbar {

/// How densely a solid's surface is sampled with contact points; each shape reads its own entry.
struct SurfaceResolution {
  std::array<int, 3> cuboid = {6, 6, 6};  ///< grid points along x, y, z, ≥ 2 each
  std::array<int, 2> sphere = {0, 0};     ///< rings, points of each; 0 0: no points
  std::array<int, 2> cylinder = {8, 3};   ///< angles and radii per end face, ≥ 1 each
  std::array<int, 2> capsule = {5, 4};    ///< rings ≥ 2, points of each ≥ 1
};

/// The most contact points that a body may have; each is tested in every contact of its body.
inline constexpr int kMaxContactPoints = 1'000'000;

/// How many points surface_points makes at a resolution, or would make if it were not refused.
[[nodiscard]] double surface_point_count(const Shape& shape, const SurfaceResolution& resolution);

/// Contact points on the surface of a solid, in the body frame (doc/scene_format.md gives their
/// order).
///
/// @returns  [3 x points]; no columns for NoShape and for a sphere of resolution 0 0
/// @throws InvalidInput for a resolution that is too small, or gives more than kMaxContactPoints
[[nodiscard]] Eigen::Matrix3Xd surface_points(const Shape& shape,
                                              const SurfaceResolution& resolution = {});

/// ∂C/∂(size k of the shape) of a surface point C that moves as the shape is resized: sides scale
/// coordinates, radii scale what is radial, the half-balls of a capsule move with its length.
///
/// @param shape  at its nominal sizes, where C lies on or in it
/// @param k      index into sizes_of(shape)
[[nodiscard]] Eigen::Vector3d surface_point_rate(const Shape& shape, const Eigen::Vector3d& C,
                                                 int k);

}  // namespace hbar
