#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/scene/polygon_mesh.h"

namespace hbar::scene {

/// The extensions of files that are read by the Assimp library, with their dots; none in a build
/// without it.
[[nodiscard]] std::vector<std::string> assimp_extensions();

/// The faces of such a file, with the transforms of its nodes applied. Points and lines are
/// skipped.
///
/// @param bytes      of the file; files that it refers to (buffers, textures) are not opened
/// @param extension  of assimp_extensions, without the dot
/// @param name       what messages call it
/// @throws InvalidInput  that begins `name: ` with Assimp's reason
[[nodiscard]] PolygonMesh read_assimp_bytes(std::string_view bytes, const std::string& extension,
                                            const std::string& name);

}  // namespace hbar::scene
