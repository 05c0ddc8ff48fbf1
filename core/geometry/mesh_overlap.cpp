#include "hbar/core/geometry/mesh_overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Eigen::Vector3d;

/// What counts as touching, as a share of the bounding box's diagonal.
constexpr double kTouching = 1e-9;
/// How far from a triangle its two sides are looked at, as a share of the diagonal.
constexpr double kBeside = 1e-7;
constexpr int kLeaf = 4;

std::string point_text(const Vector3d& p) {
  return concat("(", p.x(), ", ", p.y(), ", ", p.z(), ")");
}

/// Triangles in a tree of boxes.
class BoxTree {
 public:
  explicit BoxTree(const TriangleMesh& mesh) {
    for (const std::array<int, 3>& t : mesh.triangles) {
      const auto vertex = [&](std::size_t i) {
        return mesh.vertices[static_cast<std::size_t>(t[i])];
      };
      corners_.push_back({vertex(0), vertex(1), vertex(2)});
    }
    order_.resize(corners_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    add(0, order_.size());
  }

  using Corners = std::array<Vector3d, 3>;
  [[nodiscard]] const Corners& corners(std::size_t i) const { return corners_[i]; }
  [[nodiscard]] std::size_t count() const { return corners_.size(); }

  /// Calls visit(triangle) for every triangle whose box is wanted.
  template <typename Wanted, typename Visit>
  void visit(const Wanted& wanted, const Visit& visit) const {
    std::vector<std::size_t> waiting = {0};
    while (!waiting.empty()) {
      const Node& node = nodes_[waiting.back()];
      const std::size_t place = waiting.back();
      waiting.pop_back();
      if (!wanted(node.box)) {
        continue;
      }
      for (std::size_t i = node.first; i < node.last; ++i) {
        visit(order_[i]);
      }
      if (node.second > 0) {
        waiting.push_back(node.second);
        waiting.push_back(place + 1);
      }
    }
  }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t first = 0, last = 0;  // of a leaf's triangles
    std::size_t second = 0;           // child; the first one follows its parent
  };

  std::size_t add(std::size_t first, std::size_t last) {
    const std::size_t place = nodes_.size();
    nodes_.emplace_back();
    Eigen::AlignedBox3d box;
    for (std::size_t i = first; i < last; ++i) {
      for (const Vector3d& corner : corners_[order_[i]]) {
        box.extend(corner);
      }
    }
    nodes_[place].box = box;
    if (last - first <= kLeaf) {
      nodes_[place].first = first;
      nodes_[place].last = last;
      return place;
    }
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto centre = [&](std::size_t t) {
      return corners_[t][0][axis] + corners_[t][1][axis] + corners_[t][2][axis];
    };
    const std::size_t middle = first + (last - first) / 2;
    const auto begin = order_.begin();
    std::nth_element(begin + static_cast<std::ptrdiff_t>(first),
                     begin + static_cast<std::ptrdiff_t>(middle),
                     begin + static_cast<std::ptrdiff_t>(last),
                     [&](std::size_t a, std::size_t b) { return centre(a) < centre(b); });
    add(first, middle);
    const std::size_t second = add(middle, last);
    nodes_[place].second = second;
    return place;
  }

  std::vector<Corners> corners_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

/// Where a segment passes through the inside of a triangle, away from its edges and both ends.
std::optional<Vector3d> passage(const Vector3d& from, const Vector3d& to, const BoxTree::Corners& t,
                                double touching) {
  const Vector3d twice = (t[1] - t[0]).cross(t[2] - t[0]);
  const Vector3d normal = twice.normalized();
  const double before = normal.dot(from - t[0]);
  const double after = normal.dot(to - t[0]);
  if (!(std::min(before, after) < -touching && std::max(before, after) > touching)) {
    return std::nullopt;
  }
  const Vector3d at = from + before / (before - after) * (to - from);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = t[(i + 1) % 3] - t[i];
    if (!(normal.dot(edge.cross(at - t[i])) > touching * edge.norm())) {
      return std::nullopt;
    }
  }
  return at;
}

void check_passages(const BoxTree& tree, double touching) {
  for (std::size_t i = 0; i < tree.count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& from = tree.corners(i)[k];
      const Vector3d& to = tree.corners(i)[(k + 1) % 3];
      Eigen::AlignedBox3d box(from);
      box.extend(to);
      tree.visit(
          [&](const Eigen::AlignedBox3d& other) { return box.intersects(other); },
          [&](std::size_t j) {
            const auto at = passage(from, to, tree.corners(j), touching);
            if (at) {
              throw InvalidInput(concat("mesh: the surface cuts itself at ", point_text(*at)));
            }
          });
    }
  }
}

/// How often the surface goes around a point: 1 in the solid, 0 outside. Nothing if the ray meets
/// an edge.
std::optional<int> winding(const BoxTree& tree, const Vector3d& x, const Vector3d& ray) {
  int sum = 0;
  bool clear = true;
  const Vector3d inverse = ray.cwiseInverse();
  tree.visit(
      [&](const Eigen::AlignedBox3d& box) {
        const Vector3d a = (box.min() - x).cwiseProduct(inverse);
        const Vector3d b = (box.max() - x).cwiseProduct(inverse);
        return a.cwiseMax(b).minCoeff() >= std::max(0.0, a.cwiseMin(b).maxCoeff());
      },
      [&](std::size_t i) {
        const auto& [a, b, c] = tree.corners(i);
        // Signed volumes of the ray's line with the edges.
        const Vector3d p = a - x;
        const Vector3d q = b - x;
        const Vector3d r = c - x;
        const double u = ray.dot(q.cross(r));
        const double v = ray.dot(r.cross(p));
        const double w = ray.dot(p.cross(q));
        const double size = 1e-13 * (std::abs(u) + std::abs(v) + std::abs(w)) +
                            1e-15 * (q - p).norm() * (r - p).norm();
        const double smallest = std::min({u, v, w});
        const double largest = std::max({u, v, w});
        if (smallest < -size && largest > size) {
          return;  // passes beside it
        }
        if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= size) {
          clear = false;
          return;
        }
        const double along = p.dot((q - p).cross(r - p)) / ray.dot((q - p).cross(r - p));
        if (along > 0.0) {
          sum += u > 0.0 ? 1 : -1;
        }
      });
  return clear ? std::optional(sum) : std::nullopt;
}

/// The same; takes another ray where one meets an edge.
int winding(const BoxTree& tree, const Vector3d& x) {
  for (int i = 1; i < 100; ++i) {
    const Vector3d ray =
        Vector3d(std::cos(0.7 + 1.3 * i), std::sin(1.1 * i + 0.3), std::cos(2.1 * i)).normalized();
    if (const std::optional<int> found = winding(tree, x, ray)) {
      return *found;
    }
  }
  return 1;  // on an edge whatever the direction: no statement
}

void check_sides(const BoxTree& tree, double beside) {
  for (std::size_t i = 0; i < tree.count(); ++i) {
    const auto& [a, b, c] = tree.corners(i);
    const Vector3d centre = (a + b + c) / 3.0;
    const Vector3d normal = (b - a).cross(c - a).normalized();
    // Of a narrow triangle the other faces of a sharp edge are near.
    const double size = std::min({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const Vector3d step = std::min(beside, 1e-4 * size) * normal;
    const int outside = winding(tree, centre + step);
    const int inside = winding(tree, centre - step);
    if (inside == outside + 1 && outside == 0) {
      continue;
    }
    if (outside > 0 || inside > 1) {
      throw InvalidInput(concat("mesh: the triangle at ", point_text(centre),
                                " lies inside the solid: the surface overlaps itself, or holds two "
                                "solids that overlap"));
    }
    throw InvalidInput(concat("mesh: the part of the surface at ", point_text(centre),
                              " is turned inside out; corners run counter-clockwise seen from "
                              "outside"));
  }
}

}  // namespace

void check_overlap(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const BoxTree tree(mesh);
  const double diagonal = box.diagonal().norm();
  check_passages(tree, kTouching * diagonal);
  check_sides(tree, kBeside * diagonal);
}

}  // namespace hbar
