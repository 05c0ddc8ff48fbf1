#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hbar {

/// A surface of triangles. Seen from outside, a triangle's corners run counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< length                             n of [3]
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices, from 0        m of [3]
};

/// Refuses a surface that does not bound a solid.
///
/// @throws InvalidInput that says where, for: no triangle; a vertex that is not finite; an index
///         out of range; a triangle without area; an edge with one triangle (a hole), or more of
///         one orientation than of the other; a surface turned inside out. A surface may touch
///         itself: four triangles and more at an edge are fine
void check_solid(const TriangleMesh& mesh);

/// The same surface with vertices of equal coordinates merged.
[[nodiscard]] TriangleMesh merge_equal_vertices(const TriangleMesh& mesh);

/// Whether every edge has as many triangles of one orientation as of the other.
[[nodiscard]] bool is_closed(const TriangleMesh& mesh);

/// Moments of a homogeneous solid of density 1.
struct SolidMoments {
  double volume = 0.0;                               ///< length³
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of mass, length                     [3]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre, density·length⁵ [3 x 3]
};

/// Exact moments of the solid bounded by a surface: the sum over its triangles of the moments of
/// the tetrahedra they form with one point of the surface.
///
/// @param mesh  closed and oriented, as check_solid requires
/// @throws InvalidInput if there is no triangle or the volume is not positive
[[nodiscard]] SolidMoments solid_moments(const TriangleMesh& mesh);

}  // namespace hbar
