#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "hbar/core/geometry/mesh.h"

namespace hbar {

/// Exact signed distance to the surface of a solid: negative inside, accurate to rounding
/// everywhere. A tree of boxes finds the nearest triangle; the sign is that of the angle-weighted
/// pseudonormal of the nearest face, edge or vertex (Bærentzen & Aanæs, IEEE TVCG 11(3), 2005),
/// which is right wherever a closed surface does not touch itself; where it does, the winding
/// number decides. Immutable, and safe to share between threads.
class TriangleDistance {
 public:
  /// @param mesh  a closed surface, length, which may touch itself; vertices of equal coordinates
  ///              are one
  /// @throws InvalidInput as check_solid and check_overlap do
  explicit TriangleDistance(const TriangleMesh& mesh);

  /// @param x  a point, length                                                       [3]
  /// @returns the distance, length; 0 on the surface
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& x) const;

  /// The same, faster for a sequence of points that lie near each other.
  ///
  /// @param[in,out] hint  0 at first, then the value left by the previous point
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& x, int& hint) const;

  /// The smallest box with edges along the axes that holds the surface.
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return nodes_.front().box; }

 private:
  struct Triangle {
    std::array<Eigen::Vector3d, 3> corners;
    Eigen::Vector3d normal;  ///< unit, out of the solid
  };
  /// Where on a triangle its nearest point lies.
  enum Feature { kFace, kEdge, kVertex = kEdge + 3, kFeatures = kVertex + 3 };
  /// The nearest point found so far.
  struct Nearest {
    double squared;          ///< distance²
    Eigen::Vector3d offset;  ///< from there to x
    int triangle;            ///< the triangle it lies on
    int feature;             ///< a Feature; kEdge + i runs from corner i, kVertex + i is corner i
  };
  /// A box around some triangles: a leaf's own, or those of its two child nodes.
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;   ///< triangle of a leaf
    int count = 0;   ///< triangles of a leaf, 0 otherwise
    int second = 0;  ///< the second child; the first one follows its parent
  };

  void set_pseudonormals(const TriangleMesh& mesh);
  void set_touching(const TriangleMesh& mesh);
  [[nodiscard]] double winding_number(const Eigen::Vector3d& x) const;
  int add_node(std::vector<int>& order, int first, int last);
  void improve(const Eigen::Vector3d& x, int triangle, Nearest& nearest) const;
  void search(const Eigen::Vector3d& x, Nearest& nearest) const;

  std::vector<Triangle> triangles_;  // leaf by leaf
  std::vector<std::array<Eigen::Vector3d, kFeatures>> pseudonormals_;
  std::vector<std::array<bool, kFeatures>> touching_;  // where other sheets touch; empty: nowhere
  std::vector<Node> nodes_;
};

}  // namespace hbar
