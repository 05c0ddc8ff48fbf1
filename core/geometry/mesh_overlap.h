#pragma once

#include "hbar/core/geometry/mesh.h"

namespace hbar {

/// Refuses a closed surface that cuts or overlaps itself: an edge that passes through a triangle; a
/// triangle whose outer side lies in the solid (as where two solids of one file overlap, or one
/// lies within the other) or whose inner side does not (a part turned inside out). Cavities are
/// fine, and so are surfaces that touch.
///
/// @param mesh  closed, as check_solid asks for
/// @throws InvalidInput that says where
void check_overlap(const TriangleMesh& mesh);

}  // namespace hbar
