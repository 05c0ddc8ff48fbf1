#include "hbar/core/geometry/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// A triangle has no area if twice its area is below this times its longest side squared.
constexpr double kNoArea = 1e-14;

std::string text_of(const Eigen::Vector3d& point) {
  return concat("(", point.x(), ", ", point.y(), ", ", point.z(), ")");
}

const Eigen::Vector3d& vertex(const TriangleMesh& mesh, int index) {
  return mesh.vertices[static_cast<std::size_t>(index)];
}

/// Triangles on the two sides of an edge, by direction of travel.
struct EdgeUse {
  int from = 0;      ///< vertex of the first direction seen
  int to = 0;        ///< vertex
  int forward = 0;   ///< triangles that run from `from` to `to`
  int backward = 0;  ///< triangles that run the other way
};

using EdgeTable = std::unordered_map<std::size_t, EdgeUse>;

EdgeTable count_edges(const TriangleMesh& mesh) {
  EdgeTable edges;
  const std::size_t count = mesh.vertices.size();
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i];
      const int to = triangle[(i + 1) % 3];
      const auto low = static_cast<std::size_t>(std::min(from, to));
      const auto high = static_cast<std::size_t>(std::max(from, to));
      const auto place = edges.emplace(low * count + high, EdgeUse{from, to, 0, 0}).first;
      (place->second.from == from ? place->second.forward : place->second.backward) += 1;
    }
  }
  return edges;
}

void check_entries(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw InvalidInput("mesh: no triangle; a solid needs at least 4");
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      throw InvalidInput(concat("mesh: vertex ", i + 1, " is ", text_of(mesh.vertices[i]),
                                "; coordinates must be finite"));
    }
  }
  const int count = static_cast<int>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const int index : mesh.triangles[i]) {
      if (index < 0 || index >= count) {
        throw InvalidInput(
            concat("mesh: triangle ", i + 1, " has vertex ", index + 1, "; there are ", count));
      }
    }
  }
}

void check_areas(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d& a = vertex(mesh, mesh.triangles[i][0]);
    const Eigen::Vector3d ab = vertex(mesh, mesh.triangles[i][1]) - a;
    const Eigen::Vector3d ac = vertex(mesh, mesh.triangles[i][2]) - a;
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (!(ab.cross(ac).norm() > kNoArea * longest)) {
      throw InvalidInput(concat("mesh: triangle ", i + 1, " at ", text_of(a),
                                " has no area; its corners must not lie on a line"));
    }
  }
}

void check_edges(const TriangleMesh& mesh) {
  const EdgeTable edges = count_edges(mesh);
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {  // in the order of the mesh, so that messages are too
      const auto low = static_cast<std::size_t>(std::min(triangle[i], triangle[(i + 1) % 3]));
      const auto high = static_cast<std::size_t>(std::max(triangle[i], triangle[(i + 1) % 3]));
      const EdgeUse& use = edges.at(low * mesh.vertices.size() + high);
      if (use.forward == use.backward) {
        continue;
      }
      const int total = use.forward + use.backward;
      const std::string edge = concat("mesh: the edge from ", text_of(vertex(mesh, use.from)),
                                      " to ", text_of(vertex(mesh, use.to)));
      if (total == 1) {
        throw InvalidInput(edge + " has one triangle; a closed surface has two at each edge");
      }
      if (total > 2) {
        throw InvalidInput(concat(edge, " has ", total, " triangles, ", use.forward,
                                  " of one orientation; a closed surface has as many of each"));
      }
      throw InvalidInput(edge +
                         " has two triangles of opposite orientation; all corners must run "
                         "counter-clockwise seen from outside");
    }
  }
}

/// Sums over the tetrahedra that the triangles span with a point of the surface.
struct TetrahedronSums {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< that point
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< ∫ x dV
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< ∫ x xᵀ dV
};

/// With corners 0, a, b, c and D = det(a b c): volume D/6, ∫x = D/24 s and
/// ∫x xᵀ = D/120 (a aᵀ + b bᵀ + c cᵀ + s sᵀ), where s = a + b + c. They follow from writing
/// x = αa + βb + γc, dV = D dα dβ dγ and ∫α = 1/24, ∫α² = 1/60, ∫αβ = 1/120 over the unit simplex.
TetrahedronSums sum_tetrahedra(const TriangleMesh& mesh) {
  TetrahedronSums sums;
  sums.origin = vertex(mesh, mesh.triangles.front()[0]);
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const Eigen::Vector3d a = vertex(mesh, triangle[0]) - sums.origin;
    const Eigen::Vector3d b = vertex(mesh, triangle[1]) - sums.origin;
    const Eigen::Vector3d c = vertex(mesh, triangle[2]) - sums.origin;
    const Eigen::Vector3d s = a + b + c;
    const double D = a.dot(b.cross(c));
    sums.volume += D / 6.0;
    sums.first += D / 24.0 * s;
    sums.second +=
        D / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  return sums;
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
  for (const auto& [key, use] : count_edges(mesh)) {
    if (use.forward != use.backward) {
      return false;
    }
  }
  return !mesh.triangles.empty();
}

void check_solid(const TriangleMesh& mesh) {
  check_entries(mesh);
  check_areas(mesh);
  check_edges(mesh);
  const double volume = sum_tetrahedra(mesh).volume;
  if (!(volume > 0.0)) {
    throw InvalidInput(concat("mesh: the surface encloses the volume ", volume,
                              "; it must be positive: corners run counter-clockwise seen from "
                              "outside"));
  }
}

TriangleMesh merge_equal_vertices(const TriangleMesh& mesh) {
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::map<Eigen::Vector3d, int, decltype(less)> known(less);
  TriangleMesh merged;
  std::vector<int> new_index;
  for (const Eigen::Vector3d& point : mesh.vertices) {
    const auto [place, is_new] = known.emplace(point, static_cast<int>(merged.vertices.size()));
    if (is_new) {
      merged.vertices.push_back(point);
    }
    new_index.push_back(place->second);
  }
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    merged.triangles.push_back({new_index[static_cast<std::size_t>(triangle[0])],
                                new_index[static_cast<std::size_t>(triangle[1])],
                                new_index[static_cast<std::size_t>(triangle[2])]});
  }
  return merged;
}

SolidMoments solid_moments(const TriangleMesh& mesh) {
  check_entries(mesh);
  const TetrahedronSums sums = sum_tetrahedra(mesh);
  if (!(sums.volume > 0.0)) {
    throw InvalidInput(concat("solid_moments: the volume is ", sums.volume,
                              "; it must be positive, see check_solid"));
  }
  const Eigen::Vector3d offset = sums.first / sums.volume;
  const Eigen::Matrix3d second = sums.second - sums.volume * offset * offset.transpose();
  SolidMoments moments;
  moments.volume = sums.volume;
  moments.centre = sums.origin + offset;
  moments.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return moments;
}

}  // namespace hbar
