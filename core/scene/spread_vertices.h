#pragma once

#include "hbar/core/geometry/mesh.h"

namespace hbar::scene {

/// Vertices of a surface, well spread over it: the first is the one farthest from `centre`, each
/// further one the farthest from all chosen before; ties go to the first in the mesh. The choice is
/// the same on every machine, and a shorter list is a prefix of a longer one. Vertices that belong
/// to no triangle are skipped, and no position is taken twice.
///
/// @param mesh    any surface
/// @param centre  where the spreading begins, in the mesh's frame, length             [3]
/// @param count   how many vertices, ≥ 0; all of them if there are fewer
/// @returns       in the order chosen, in the mesh's frame, length           [3 x points]
[[nodiscard]] Eigen::Matrix3Xd spread_vertices(const TriangleMesh& mesh,
                                               const Eigen::Vector3d& centre, int count);

}  // namespace hbar::scene
