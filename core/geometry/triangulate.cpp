#include "hbar/core/geometry/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <numeric>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Triangle = std::array<int, 3>;

/// A cross product below this, times the extent squared, is that of points on a line.
constexpr double kFlat = 1e-12;
/// A corner so near the cut, in its lengths, would be left with a sliver beside it: only if there
/// is no other way.
constexpr double kNearCut = 1e-2;
/// From so many corners on, the next ear is as good as the best.
constexpr std::size_t kMany = 64;

/// A polygon in its plane, and the part of it that is not yet cut.
class Clipper {
 public:
  explicit Clipper(const std::vector<Eigen::Vector3d>& corners) : left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), 0);
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // twice the area vector
    double extent = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d from = corners[i] - corners[0];
      normal += from.cross(corners[(i + 1) % corners.size()] - corners[0]);
      extent = std::max(extent, from.squaredNorm());
    }
    flat_ = kFlat * extent;
    if (!(normal.norm() > flat_)) {
      throw InvalidInput("the corners lie on a line; a face has an area");
    }
    const Eigen::Vector3d x = normal.unitOrthogonal();
    const Eigen::Vector3d y = normal.normalized().cross(x);
    for (const Eigen::Vector3d& corner : corners) {
      points_.emplace_back(x.dot(corner - corners[0]), y.dot(corner - corners[0]));
    }
  }

  std::vector<Triangle> cut() {
    std::vector<Triangle> triangles;
    while (left_.size() > 3) {
      const std::size_t tip = find_ear();
      triangles.push_back(ear(tip));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(tip));
      start_ = tip;  // the next ear at the other side of the cut: fewer slivers
    }
    if (!(twice_area(ear(1)) > flat_)) {
      refuse();
    }
    triangles.push_back(ear(1));
    return triangles;
  }

 private:
  [[noreturn]] static void refuse() {
    throw InvalidInput("the face cuts or touches itself; its corners must bound a simple polygon");
  }
  [[nodiscard]] const Eigen::Vector2d& point(int corner) const {
    return points_[static_cast<std::size_t>(corner)];
  }
  /// The triangle at a corner that is left, with its neighbours.
  [[nodiscard]] Triangle ear(std::size_t tip) const {
    const std::size_t count = left_.size();
    return {left_[(tip + count - 1) % count], left_[tip], left_[(tip + 1) % count]};
  }
  [[nodiscard]] double side(int a, int b, const Eigen::Vector2d& p) const {
    const Eigen::Vector2d edge = point(b) - point(a);
    return edge.x() * (p.y() - point(a).y()) - edge.y() * (p.x() - point(a).x());
  }
  [[nodiscard]] double twice_area(const Triangle& t) const { return side(t[0], t[1], point(t[2])); }

  /// Whether no other corner lies in the triangle or on its cut, which would then miss it.
  [[nodiscard]] bool is_ear(const Triangle& t, double near_cut) const {
    if (!(twice_area(t) > flat_)) {
      return false;
    }
    const double beyond_cut =
        -std::max(flat_, near_cut * (point(t[2]) - point(t[0])).squaredNorm());
    return std::none_of(left_.begin(), left_.end(), [&](int corner) {
      if (corner == t[0] || corner == t[1] || corner == t[2]) {
        return false;
      }
      const Eigen::Vector2d& p = point(corner);
      return side(t[0], t[1], p) >= -flat_ && side(t[1], t[2], p) >= -flat_ &&
             side(t[2], t[0], p) >= beyond_cut;
    });
  }

  /// Area over the longest side squared: how far a triangle is from a sliver.
  [[nodiscard]] double quality(const Triangle& t) const {
    const double longest = std::max({(point(t[1]) - point(t[0])).squaredNorm(),
                                     (point(t[2]) - point(t[1])).squaredNorm(),
                                     (point(t[0]) - point(t[2])).squaredNorm()});
    return twice_area(t) / longest;
  }

  /// The ear of best shape; of many corners, the next.
  [[nodiscard]] std::size_t find_ear() const {
    const std::size_t good = find_ear(kNearCut);
    const std::size_t found = good < left_.size() ? good : find_ear(0.0);
    if (found == left_.size()) {
      refuse();
    }
    return found;
  }

  /// The same, or how many corners are left.
  [[nodiscard]] std::size_t find_ear(double near_cut) const {
    const std::size_t count = left_.size();
    std::size_t best = count;
    double best_quality = 0.0;
    for (std::size_t i = 1; i <= count; ++i) {
      const std::size_t tip = (start_ + i) % count;
      // A relative margin, so that rounding does not choose between equals.
      const double its = quality(ear(tip));
      if (its > best_quality * (1.0 + 1e-9) && is_ear(ear(tip), near_cut)) {
        best = tip;
        best_quality = its;
        if (count > kMany) {
          break;
        }
      }
    }
    return best;
  }

  std::vector<Eigen::Vector2d> points_;
  std::vector<int> left_;  // corners not yet cut off, in order
  std::size_t start_ = 0;
  double flat_ = 0.0;
};

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Eigen::Vector3d>& corners) {
  if (corners.size() < 3) {
    throw InvalidInput(concat("a face of ", corners.size(), " corners; it has at least 3"));
  }
  if (corners.size() == 3) {
    return {{0, 1, 2}};
  }
  return Clipper(corners).cut();
}

}  // namespace hbar
