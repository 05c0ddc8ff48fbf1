#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "hbar/core/geometry/distance_grid.h"
#include "hbar/core/geometry/mesh.h"
#include "hbar/core/scene/polygon_mesh.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {

/// Does with the faces of a file what a scene does: closes the surface, computes the moments of the
/// solid and its distance grid.
inline void try_solid(scene::PolygonMesh polygons, const std::string& name) {
  constexpr std::size_t kMostTriangles = 64;  // more are slow, and no mistake of a reader
  const TriangleMesh mesh = scene::triangulated(std::move(polygons), name).mesh;
  check_solid(mesh);
  const SolidMoments moments = solid_moments(mesh);
  require(moments.volume > 0.0, "a solid without volume");
  require(moments.centre.allFinite() && moments.inertia.allFinite(),
          "a solid whose moments are not finite");
  if (mesh.triangles.size() > kMostTriangles) {
    return;
  }
  const DistanceGrid grid(mesh, kMinDistanceCells);
  require(std::isfinite(grid.max_error()), "a distance grid whose error is not finite");
  require(std::isfinite(grid.sample(moments.centre).distance), "a distance that is not finite");
  require(DistanceGrid(grid.bytes()).bytes() == grid.bytes(), "a grid is not restored");
}

}  // namespace hbar::fuzz
