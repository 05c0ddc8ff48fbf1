#pragma once

#include "hbar/core/geometry/mesh.h"

namespace hbar::scene {

/// Vertices of a surface, well spread over it: the first is the one farthest from `centre`, each
/// further one the farthest from all before it; of equally far ones the first of the mesh. So the
/// choice is the same on every machine, and fewer points are the beginning of more. Vertices no
/// triangle has are not taken, nor is a place twice.
///
/// @param mesh    any surface
/// @param centre  where the spreading begins, in the mesh's frame, length             [3]
/// @param count   how many vertices, ≥ 0; all of them if there are fewer
/// @returns       in the order of their choice, in the mesh's frame, length  [3 x points]
[[nodiscard]] Eigen::Matrix3Xd spread_vertices(const TriangleMesh& mesh,
                                               const Eigen::Vector3d& centre, int count);

}  // namespace hbar::scene
