#pragma once

#include <filesystem>
#include <memory>

#include "hbar/core/geometry/distance_field.h"
#include "hbar/core/geometry/mesh.h"

namespace hbar::scene {

/// The distance grid of a mesh (see DistanceGrid), kept beside the mesh's file for the next time.
/// A kept grid that is damaged is made anew, and where none can be kept, none is.
///
/// @param mesh_in_body_frame  a closed surface, length
/// @param cells               along the longest side of its bounding box
/// @param mesh_file           the file the mesh is from
/// @throws InvalidInput as DistanceGrid does
[[nodiscard]] std::shared_ptr<const DistanceField> cached_mesh_distance(
    const TriangleMesh& mesh_in_body_frame, int cells, const std::filesystem::path& mesh_file);

/// Where that grid is kept: `MESH_FILE.HASH.hbar-distance`, with 16 hexadecimal digits for all that
/// the grid depends on. Another mesh, or another number of cells, has another file; the old one
/// stays.
[[nodiscard]] std::filesystem::path distance_cache_path(const TriangleMesh& mesh_in_body_frame,
                                                        int cells,
                                                        const std::filesystem::path& mesh_file);

}  // namespace hbar::scene
