#include "hbar/core/geometry/mend_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <unordered_map>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

constexpr double kNearVertices = 1e-6;  ///< of the bounding box's diagonal

std::size_t slot(int index) { return static_cast<std::size_t>(index); }

double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  return mesh.vertices.empty() ? 0.0 : box.diagonal().norm();
}

/// Edges by direction: how many triangles run along each.
std::map<Edge, int> directed_edges(const TriangleMesh& mesh) {
  std::map<Edge, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++edges[{t[i], t[(i + 1) % 3]}];
    }
  }
  return edges;
}

/// Edges of a triangle that no triangle runs along the other way, as often.
std::vector<Edge> open_edges(const TriangleMesh& mesh) {
  const std::map<Edge, int> edges = directed_edges(mesh);
  std::vector<Edge> open;
  for (const auto& [edge, count] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end() || other->second < count) {
      open.push_back(edge);
    }
  }
  return open;
}

bool repeats_a_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Vertices that are one keep the place of the first; `one` maps each to it.
TriangleMesh with_merged(const TriangleMesh& mesh, const std::vector<int>& one) {
  TriangleMesh merged;
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (slot(one[i]) == i) {
      new_index[i] = static_cast<int>(merged.vertices.size());
      merged.vertices.push_back(mesh.vertices[i]);
    }
  }
  for (const Triangle& t : mesh.triangles) {
    const auto moved = [&](int corner) { return new_index[slot(one[slot(corner)])]; };
    const Triangle now = {moved(t[0]), moved(t[1]), moved(t[2])};
    if (!repeats_a_corner(now)) {
      merged.triangles.push_back(now);
    }
  }
  return merged;
}

/// For each vertex, the first that is nearer than a distance; looked for in a grid of that size.
std::vector<int> near_vertices(const TriangleMesh& mesh, double distance) {
  std::map<std::array<std::int64_t, 3>, std::vector<int>> cells;
  std::vector<int> one(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d& point = mesh.vertices[i];
    std::array<std::int64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      cell[k] =
          static_cast<std::int64_t>(std::floor(point[static_cast<Eigen::Index>(k)] / distance));
    }
    int found = -1;
    for (int offset = 0; offset < 27; ++offset) {
      const std::array<std::int64_t, 3> beside = {
          cell[0] + offset % 3 - 1, cell[1] + offset / 3 % 3 - 1, cell[2] + offset / 9 - 1};
      const auto place = cells.find(beside);
      for (const int other : place == cells.end() ? std::vector<int>() : place->second) {
        const bool near = (mesh.vertices[slot(other)] - point).norm() < distance;
        if (near && (found < 0 || other < found)) {
          found = other;
        }
      }
    }
    one[i] = found < 0 ? static_cast<int>(i) : found;
    if (found < 0) {
      cells[cell].push_back(static_cast<int>(i));
    }
  }
  return one;
}

/// Twice the area over the longest side: the height over it.
double height_of(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d& a = mesh.vertices[slot(t[0])];
  const Eigen::Vector3d ab = mesh.vertices[slot(t[1])] - a;
  const Eigen::Vector3d ac = mesh.vertices[slot(t[2])] - a;
  const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  return longest > 0.0 ? ab.cross(ac).norm() / longest : 0.0;
}

std::size_t drop_flat(TriangleMesh& mesh, double height) {
  return std::erase_if(mesh.triangles,
                       [&](const Triangle& t) { return !(height_of(mesh, t) > height); });
}

/// The open end of another triangle nearest to the beginning of an open edge, on its way; none: −1.
int vertex_on(const TriangleMesh& mesh, const Edge& edge, const std::vector<int>& ends,
              double near) {
  const Eigen::Vector3d& from = mesh.vertices[slot(edge.first)];
  const Eigen::Vector3d way = mesh.vertices[slot(edge.second)] - from;
  const double length = way.norm();
  int found = -1;
  double first = length - near;
  for (const int end : ends) {
    const Eigen::Vector3d offset = mesh.vertices[slot(end)] - from;
    const double along = way.dot(offset) / length;
    if (end != edge.first && end != edge.second && along > near && along < first &&
        (offset - along / length * way).norm() < near) {
      found = end;
      first = along;
    }
  }
  return found;
}

/// Splits triangles at other open ends that lie on their open edges, until none does.
std::size_t split_at_vertices(TriangleMesh& mesh, double near) {
  std::size_t splits = 0;
  for (bool again = true; again;) {
    again = false;
    const std::vector<Edge> open = open_edges(mesh);
    std::vector<int> ends;
    for (const Edge& edge : open) {
      ends.push_back(edge.first);
      ends.push_back(edge.second);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::map<Edge, int> at_edge;
    for (const Edge& edge : open) {
      if (const int vertex = vertex_on(mesh, edge, ends, near); vertex >= 0) {
        at_edge[edge] = vertex;
      }
    }
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count && !at_edge.empty(); ++t) {
      const Triangle corners = mesh.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const auto place = at_edge.find({corners[i], corners[(i + 1) % 3]});
        if (place == at_edge.end() || place->second == corners[(i + 2) % 3]) {
          continue;
        }
        mesh.triangles[t] = {corners[i], place->second, corners[(i + 2) % 3]};
        mesh.triangles.push_back({place->second, corners[(i + 1) % 3], corners[(i + 2) % 3]});
        at_edge.erase(place);
        ++splits;
        again = true;
        break;
      }
    }
  }
  return splits;
}

/// Drops pairs of triangles on the same vertices that face each other.
std::size_t drop_facing_pairs(TriangleMesh& mesh) {
  std::map<Triangle, std::array<std::vector<std::size_t>, 2>> by_corners;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle sorted = mesh.triangles[i];
    std::rotate(sorted.begin(), std::min_element(sorted.begin(), sorted.end()), sorted.end());
    const bool turned = sorted[1] > sorted[2];
    if (turned) {
      std::swap(sorted[1], sorted[2]);
    }
    by_corners[sorted][turned ? 1 : 0].push_back(i);
  }
  std::vector<bool> dropped(mesh.triangles.size(), false);
  std::size_t pairs = 0;
  for (const auto& [corners, ways] : by_corners) {
    const std::size_t both = std::min(ways[0].size(), ways[1].size());
    for (std::size_t i = 0; i < both; ++i) {
      dropped[ways[0][i]] = dropped[ways[1][i]] = true;
    }
    pairs += both;
  }
  std::size_t i = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return dropped[i++]; });
  return pairs;
}

void check_indices(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      throw InvalidInput(concat("mesh: vertex ", i + 1, " is not finite"));
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (const int corner : t) {
      if (corner < 0 || slot(corner) >= mesh.vertices.size()) {
        throw InvalidInput(concat("mesh: a triangle has vertex ", corner + 1, "; there are ",
                                  mesh.vertices.size()));
      }
    }
  }
}

}  // namespace

MendedMesh mend_mesh(TriangleMesh mesh) {
  check_indices(mesh);
  MendedMesh out{std::move(mesh)};
  const auto tell = [&out](std::size_t count, const char* one, const char* many) {
    if (count > 0) {
      out.notices.push_back(count == 1 ? std::string(one) : concat(count, ' ', many));
    }
  };
  std::erase_if(out.mesh.triangles, repeats_a_corner);
  const double near = kNearVertices * diagonal_of(out.mesh);
  if (!open_edges(out.mesh).empty()) {
    out.mesh = merge_equal_vertices(out.mesh);
    std::erase_if(out.mesh.triangles, repeats_a_corner);
  }
  if (near > 0.0 && !open_edges(out.mesh).empty()) {
    TriangleMesh merged = with_merged(out.mesh, near_vertices(out.mesh, near));
    const std::size_t count = out.mesh.vertices.size() - merged.vertices.size();
    if (open_edges(merged).size() < open_edges(out.mesh).size()) {
      out.mesh = std::move(merged);
      tell(count, "a vertex lies within 1e-6 of the bounding box's diagonal of another: merged",
           "vertices lie within 1e-6 of the bounding box's diagonal of others: merged");
    }
  }
  tell(drop_flat(out.mesh, 1e-14 * diagonal_of(out.mesh)), "a triangle has no area: dropped",
       "triangles have no area: dropped");
  if (near > 0.0 && !open_edges(out.mesh).empty()) {
    tell(split_at_vertices(out.mesh, near), "a triangle has another's vertex on its edge: split",
         "triangles have another's vertex on their edge: split");
  }
  tell(drop_facing_pairs(out.mesh), "two triangles face each other on the same corners: dropped",
       "pairs of triangles face each other on the same corners: dropped");
  return out;
}

}  // namespace hbar
