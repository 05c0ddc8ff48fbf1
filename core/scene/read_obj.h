#pragma once

#include <string>
#include <string_view>

#include "hbar/core/scene/polygon_mesh.h"

namespace hbar::scene {

/// The faces of an OBJ file. Lines read: `v x y z` and `f` with three or more corners, each `v`,
/// `v/vt`, `v//vn` or `v/vt/vn` with parts after the first that may be empty; counted from 1, or
/// from the last vertex as −1. Faces may come before their vertices. Lines skipped: vt vn vp g o s
/// usemtl mtllib l p, and comments; a line that ends with \ goes on in the next.
///
/// @param text  of the file
/// @param name  what messages call it
/// @throws InvalidInput  that begins `name:line:` for anything else: a number that is not finite,
/// an
///                       index out of range, no face at all
[[nodiscard]] PolygonMesh read_obj_text(std::string_view text, const std::string& name);

}  // namespace hbar::scene
