#include "hbar/core/scene/polygon_mesh.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/triangulate.h"
#include "hbar/core/scene/text_lines.h"

namespace hbar::scene {
namespace {

/// Without corners that repeat the one before.
std::vector<int> without_repeats(std::vector<int> corners) {
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  while (corners.size() > 1 && corners.front() == corners.back()) {
    corners.pop_back();
  }
  return corners;
}

[[noreturn]] void fail_in_face(const std::string& name, int line, const std::string& what) {
  if (line > 0) {
    fail_in_line(name, line, what);
  }
  throw InvalidInput(concat(name, ": ", what));
}

}  // namespace

MendedMesh triangulated(PolygonMesh polygons, const std::string& name) {
  TriangleMesh mesh;
  mesh.vertices = std::move(polygons.vertices);
  int dropped = 0;
  for (const Polygon& polygon : polygons.polygons) {
    const std::vector<int> corners = without_repeats(polygon.corners);
    std::vector<int> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (std::set<int>(sorted.begin(), sorted.end()).size() < 3) {
      ++dropped;
      continue;
    }
    const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
    if (repeated != sorted.end()) {
      fail_in_face(
          name, polygon.line,
          concat("the face has vertex ", *repeated + 1, " twice; its corners must differ"));
    }
    std::vector<Eigen::Vector3d> points;
    for (const int corner : corners) {
      points.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
    try {
      for (const std::array<int, 3>& t : triangulate(points)) {
        const auto index = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
        mesh.triangles.push_back({index(t[0]), index(t[1]), index(t[2])});
      }
    } catch (const InvalidInput& error) {
      fail_in_face(name, polygon.line, error.what());
    }
  }
  MendedMesh mended = mend_mesh(std::move(mesh));
  if (dropped > 0) {
    mended.notices.insert(mended.notices.begin(),
                          dropped == 1
                              ? std::string("a face has fewer than 3 vertices: dropped")
                              : concat(dropped, " faces have fewer than 3 vertices: dropped"));
  }
  return mended;
}

}  // namespace hbar::scene
