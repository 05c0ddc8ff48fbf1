#pragma once

#include <string>
#include <string_view>

#include "hbar/core/scene/polygon_mesh.h"

namespace hbar::scene {

/// The facets of an STL file, binary or ASCII; which one its length tells, because binary files may
/// begin with "solid", too. Normals and attributes are skipped: the order of the corners tells
/// which side is out. Binary files hold numbers of single precision.
///
/// @param bytes  of the file
/// @param name   what messages call it
/// @throws InvalidInput  that begins `name:line:` (ASCII) or `name: facet N:` (binary) for what is
///                       missing, too much, or no finite number
[[nodiscard]] PolygonMesh read_stl_bytes(std::string_view bytes, const std::string& name);

}  // namespace hbar::scene
