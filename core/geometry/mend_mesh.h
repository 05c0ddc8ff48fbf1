#pragma once

#include <string>
#include <vector>

#include "hbar/core/geometry/mesh.h"

namespace hbar {

/// A surface that was closed, and what was done to it.
struct MendedMesh {
  TriangleMesh mesh;
  std::vector<std::string> notices = {};  ///< clauses for the user; empty if nothing was changed
};

/// Closes a surface that other programs would call closed. Each of these is done only where it is
/// needed, and all but the first are told:
///
/// - vertices of equal coordinates are merged;
/// - vertices closer than 1e-6 of the bounding box's diagonal are merged;
/// - triangles without area are dropped;
/// - a triangle with another's vertex on its edge is split there;
/// - two triangles on the same vertices that face each other are dropped: the solids on their two
///   sides are one.
///
/// What is still open is returned as it is; check_solid tells where.
///
/// @throws InvalidInput if a vertex is not finite or an index is none
[[nodiscard]] MendedMesh mend_mesh(TriangleMesh mesh);

}  // namespace hbar
