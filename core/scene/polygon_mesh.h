#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hbar/core/geometry/mend_mesh.h"

namespace hbar::scene {

/// A face of a file.
struct Polygon {
  std::vector<int> corners;  ///< indices of vertices, from 0
  int line = 0;              ///< where the file has it, for messages; 0: it has no lines
};

/// A surface of polygons, as a file has it.
struct PolygonMesh {
  std::vector<Eigen::Vector3d> vertices = {};  ///< length                              n of [3]
  std::vector<Polygon> polygons = {};
};

/// Cuts the polygons into triangles (triangulate) and closes the surface (mend_mesh). A face whose
/// corners are fewer than three vertices is dropped.
///
/// @param name  what messages call the file
/// @throws InvalidInput that begins `name:line: ` for a face with a vertex twice, without area or
///   that cuts itself; or as mend_mesh
[[nodiscard]] MendedMesh triangulated(PolygonMesh polygons, const std::string& name);

}  // namespace hbar::scene
