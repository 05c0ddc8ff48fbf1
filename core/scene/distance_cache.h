#pragma once

#include <atomic>
#include <filesystem>
#include <memory>

#include "hbar/core/geometry/distance_field.h"
#include "hbar/core/geometry/mesh.h"

namespace hbar::scene {

/// The distance grid of a mesh (see DistanceGrid), cached beside the mesh's file. A damaged cache
/// file is replaced; if none can be written, none is.
///
/// @param mesh_in_body_frame  a closed surface, length
/// @param cells               along the longest side of its bounding box
/// @param mesh_file           the file the mesh comes from
/// @param stop                ends the computation when it is set; may be null
/// @throws InvalidInput, Interrupted  as DistanceGrid does
[[nodiscard]] std::shared_ptr<const DistanceField> cached_mesh_distance(
    const TriangleMesh& mesh_in_body_frame, int cells, const std::filesystem::path& mesh_file,
    const std::atomic<bool>* stop = nullptr);

/// Where that grid is cached: `MESH_FILE.HASH.hbar-distance`, with 16 hexadecimal digits that
/// depend on everything the grid depends on. Another mesh or number of cells gets another file; the
/// old one stays.
[[nodiscard]] std::filesystem::path distance_cache_path(const TriangleMesh& mesh_in_body_frame,
                                                        int cells,
                                                        const std::filesystem::path& mesh_file);

}  // namespace hbar::scene
