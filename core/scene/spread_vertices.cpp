#include "hbar/core/scene/spread_vertices.h"

#include <algorithm>
#include <vector>

namespace hbar::scene {
namespace {

/// Relative difference of squared distances that count as equal: compilers round them differently,
/// and the choice must not depend on that.
constexpr double kTie = 1e-10;

/// The vertices that triangles have, in the order of the mesh.
std::vector<Eigen::Vector3d> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      used[static_cast<std::size_t>(corner)] = true;
    }
  }
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) {
      vertices.push_back(mesh.vertices[i]);
    }
  }
  return vertices;
}

}  // namespace

Eigen::Matrix3Xd spread_vertices(const TriangleMesh& mesh, const Eigen::Vector3d& centre,
                                 int count) {
  const std::vector<Eigen::Vector3d> vertices = used_vertices(mesh);
  std::vector<double> gaps;  // squared distance of each vertex from those chosen
  gaps.reserve(vertices.size());
  for (const Eigen::Vector3d& vertex : vertices) {
    gaps.push_back((vertex - centre).squaredNorm());
  }
  std::vector<Eigen::Vector3d> chosen;
  while (static_cast<int>(chosen.size()) < count && !vertices.empty()) {
    const double largest = *std::max_element(gaps.begin(), gaps.end());
    if (!chosen.empty() && largest == 0.0) {
      break;
    }
    const auto farthest = std::find_if(
        gaps.begin(), gaps.end(), [largest](double gap) { return gap >= largest * (1.0 - kTie); });
    const Eigen::Vector3d next = vertices[static_cast<std::size_t>(farthest - gaps.begin())];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double gap = (vertices[i] - next).squaredNorm();
      gaps[i] = chosen.empty() ? gap : std::min(gaps[i], gap);
    }
    chosen.push_back(next);
  }
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = chosen[i];
  }
  return columns;
}

}  // namespace hbar::scene
