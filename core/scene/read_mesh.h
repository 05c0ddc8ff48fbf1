#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hbar/core/geometry/mend_mesh.h"

namespace hbar::scene {

/// The surface of a solid from a file: OBJ, STL, and with the Assimp library DAE, PLY, glTF and
/// GLB. The extension tells which. Axes and lengths are the file's, except that the lengths of DAE
/// files, which name their unit, become metres.
///
/// @param path  the file
/// @returns its triangles, closed as mend_mesh does, and what was done
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  if it is not such a file, or of a kind that this build does not read
[[nodiscard]] MendedMesh read_mesh(const std::filesystem::path& path);

/// The extensions that this build reads, with their dots.
[[nodiscard]] std::vector<std::string> mesh_extensions();

}  // namespace hbar::scene
