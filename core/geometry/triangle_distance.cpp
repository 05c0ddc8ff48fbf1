#include "hbar/core/geometry/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "hbar/core/geometry/mesh_overlap.h"

namespace hbar {
namespace {

/// Largest number of triangles in a leaf: fewer mean more boxes to test, more mean more triangles.
constexpr int kLeafTriangles = 4;
/// Boxes pending while the tree is searched: one per level, and halving 2³¹ triangles takes 31
/// levels.
constexpr std::size_t kWaiting = 64;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// The mesh with equal vertices merged.
TriangleMesh closed_mesh(const TriangleMesh& mesh) {
  const auto exists = [&](int i) { return i >= 0 && at(i) < mesh.vertices.size(); };
  const bool mendable =
      std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                  [](const Eigen::Vector3d& vertex) { return vertex.allFinite(); }) &&
      std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
        return std::all_of(triangle.begin(), triangle.end(), exists);
      });
  TriangleMesh closed = mendable ? merge_equal_vertices(mesh) : mesh;
  check_solid(closed);
  check_overlap(closed);
  return closed;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

TriangleDistance::TriangleDistance(const TriangleMesh& mesh) {
  const TriangleMesh closed = closed_mesh(mesh);
  for (const std::array<int, 3>& indices : closed.triangles) {
    const Eigen::Vector3d& a = closed.vertices[at(indices[0])];
    const Eigen::Vector3d& b = closed.vertices[at(indices[1])];
    const Eigen::Vector3d& c = closed.vertices[at(indices[2])];
    triangles_.push_back({{a, b, c}, (b - a).cross(c - a).normalized()});
  }
  set_pseudonormals(closed);
  set_touching(closed);

  std::vector<int> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0);
  add_node(order, 0, static_cast<int>(order.size()));
  const auto sorted = [&](const auto& list) {
    auto result = list;
    std::transform(order.begin(), order.end(), result.begin(), [&](int i) { return list[at(i)]; });
    return result;
  };
  triangles_ = sorted(triangles_);
  pseudonormals_ = sorted(pseudonormals_);
  if (!touching_.empty()) {
    touching_ = sorted(touching_);
  }
}

void TriangleDistance::set_pseudonormals(const TriangleMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  const auto key = [&](int from, int to) {
    return at(std::min(from, to)) * count + at(std::max(from, to));
  };
  std::unordered_map<std::size_t, Eigen::Vector3d> at_edge;
  std::vector<Eigen::Vector3d> at_vertex(count, Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [corners, normal] = triangles_[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const std::size_t last = (i + 2) % 3;
      const std::array<int, 3>& indices = mesh.triangles[t];
      at_edge.emplace(key(indices[i], indices[next]), Eigen::Vector3d::Zero()).first->second +=
          normal;
      at_vertex[at(indices[i])] +=
          angle_between(corners[next] - corners[i], corners[last] - corners[i]) * normal;
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    std::array<Eigen::Vector3d, kFeatures>& normals = pseudonormals_.emplace_back();
    normals[kFace] = triangles_[t].normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<int, 3>& indices = mesh.triangles[t];
      normals[kEdge + i] = at_edge.at(key(indices[i], indices[(i + 1) % 3]));
      normals[kVertex + i] = at_vertex[at(indices[i])];
    }
  }
}

/// Marks edges of more than two triangles, and vertices where fans of triangles meet that no edge
/// joins, or at the end of such an edge.
void TriangleDistance::set_touching(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> at_edge;  // corners, 3 t + i
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<int, 3>& c = mesh.triangles[t];
      at_edge[std::minmax(c[i], c[(i + 1) % 3])].push_back(3 * t + i);
    }
  }
  std::vector<std::size_t> fan(3 * mesh.triangles.size());  // a corner before it in the same fan
  std::iota(fan.begin(), fan.end(), std::size_t{0});
  const auto root = [&fan](std::size_t corner) {
    while (fan[corner] != corner) {
      fan[corner] = fan[fan[corner]];
      corner = fan[corner];
    }
    return corner;
  };
  const auto next = [](std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  std::vector<bool> vertex_touches(mesh.vertices.size(), false);
  bool any = false;
  for (const auto& [edge, corners] : at_edge) {
    if (corners.size() > 2) {
      any = vertex_touches[at(edge.first)] = vertex_touches[at(edge.second)] = true;
      continue;
    }
    // One runs along the edge, the other against it: the end of one is the beginning of the other.
    fan[root(corners[0])] = root(next(corners[1]));
    fan[root(next(corners[0]))] = root(corners[1]);
  }
  std::vector<std::size_t> fan_of(mesh.vertices.size(), fan.size());
  for (std::size_t corner = 0; corner < fan.size(); ++corner) {
    const std::size_t vertex = at(mesh.triangles[corner / 3][corner % 3]);
    if (fan_of[vertex] == fan.size()) {
      fan_of[vertex] = root(corner);
    }
    if (fan_of[vertex] != root(corner)) {
      any = vertex_touches[vertex] = true;
    }
  }
  if (!any) {
    return;
  }
  touching_.resize(mesh.triangles.size());
  for (std::size_t corner = 0; corner < fan.size(); ++corner) {
    const std::array<int, 3>& c = mesh.triangles[corner / 3];
    const std::size_t i = corner % 3;
    std::array<bool, kFeatures>& marks = touching_[corner / 3];
    marks[kVertex + i] = vertex_touches[at(c[i])];
    marks[kEdge + i] = at_edge.at(std::minmax(c[i], c[(i + 1) % 3])).size() > 2;
  }
}

/// How often the surface goes around x: the sum of the solid angles of its triangles over 4 π (A.
/// van Oosterom & J. Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983).
double TriangleDistance::winding_number(const Eigen::Vector3d& x) const {
  double sum = 0.0;
  for (const Triangle& triangle : triangles_) {
    const Eigen::Vector3d a = triangle.corners[0] - x;
    const Eigen::Vector3d b = triangle.corners[1] - x;
    const Eigen::Vector3d c = triangle.corners[2] - x;
    sum += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                             b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return sum / (2.0 * std::numbers::pi);
}

/// Adds the triangles order[first] to order[last - 1], halved where their centres spread most, and
/// returns the node's place.
int TriangleDistance::add_node(std::vector<int>& order, int first, int last) {
  const auto centre = [&](int t) -> Eigen::Vector3d {
    const auto& corners = triangles_[at(t)].corners;
    return corners[0] + corners[1] + corners[2];
  };
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centres;
  for (int i = first; i < last; ++i) {
    for (const Eigen::Vector3d& corner : triangles_[at(order[at(i)])].corners) {
      box.extend(corner);
    }
    centres.extend(centre(order[at(i)]));
  }
  const int place = static_cast<int>(nodes_.size());
  nodes_.push_back({box, first, last - first, 0});
  if (last - first <= kLeafTriangles) {
    return place;
  }

  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [&](int a, int b) { return centre(a)[axis] < centre(b)[axis]; });
  add_node(order, first, middle);
  const int second = add_node(order, middle, last);
  nodes_[at(place)].count = 0;
  nodes_[at(place)].second = second;
  return place;
}

void TriangleDistance::improve(const Eigen::Vector3d& x, int triangle, Nearest& nearest) const {
  const auto& [corners, normal] = triangles_[at(triangle)];
  const double height = normal.dot(x - corners[0]);
  if (!(height * height < nearest.squared)) {
    return;
  }

  bool over_face = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % 3] - corners[i];
    over_face = over_face && normal.cross(edge).dot(x - corners[i]) >= 0.0;
  }
  if (over_face) {
    nearest = {height * height, height * normal, triangle, kFace};
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const Eigen::Vector3d edge = corners[next] - corners[i];
    const double along = edge.dot(x - corners[i]) / edge.squaredNorm();
    Eigen::Vector3d offset = x - corners[i];
    std::size_t feature = kVertex + i;
    if (along >= 1.0) {
      offset = x - corners[next];
      feature = kVertex + next;
    } else if (along > 0.0) {
      offset -= along * edge;
      feature = kEdge + i;
    }
    const double squared = offset.squaredNorm();
    if (squared < nearest.squared) {
      nearest = {squared, offset, triangle, static_cast<int>(feature)};
    }
  }
}

void TriangleDistance::search(const Eigen::Vector3d& x, Nearest& nearest) const {
  std::array<std::pair<double, int>, kWaiting> waiting;  // distance², node
  std::size_t count = 0;
  waiting[count++] = {0.0, 0};
  while (count > 0) {
    const auto [squared, place] = waiting[--count];
    if (!(squared < nearest.squared)) {
      continue;
    }
    const Node& node = nodes_[at(place)];
    for (int t = node.first; t < node.first + node.count; ++t) {
      improve(x, t, nearest);
    }
    if (node.count > 0) {
      continue;
    }
    std::pair<double, int> near(nodes_[at(place + 1)].box.squaredExteriorDistance(x), place + 1);
    std::pair<double, int> far(nodes_[at(node.second)].box.squaredExteriorDistance(x), node.second);
    if (far.first < near.first) {
      std::swap(near, far);
    }
    waiting[count++] = far;
    waiting[count++] = near;
  }
}

double TriangleDistance::signed_distance(const Eigen::Vector3d& x) const {
  int hint = 0;
  return signed_distance(x, hint);
}

double TriangleDistance::signed_distance(const Eigen::Vector3d& x, int& hint) const {
  if (x.hasNaN()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  Nearest nearest = {std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0, kFace};
  improve(x, hint, nearest);
  search(x, nearest);
  hint = nearest.triangle;
  const double distance = std::sqrt(nearest.squared);
  if (!touching_.empty() && touching_[at(hint)][at(nearest.feature)]) {
    return winding_number(x) > 0.5 ? -distance : distance;
  }
  const double side = pseudonormals_[at(hint)][at(nearest.feature)].dot(nearest.offset);
  return side < 0.0 ? -distance : distance;
}

}  // namespace hbar
