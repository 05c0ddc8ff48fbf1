#pragma once

#include <Eigen/Core>
#include <vector>

namespace hbar {

/// The nodes of a uniform grid.
struct GridNodes {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< the first node, length                [3]
  double spacing = 1.0;  ///< between neighbours on every axis, length, > 0
  Eigen::Vector3i count = Eigen::Vector3i::Zero();  ///< nodes along x, y, z, ≥ 4 each         [3]

  /// Node (i, j, k), length.                                                                   [3]
  [[nodiscard]] Eigen::Vector3d point(int i, int j, int k) const {
    return origin + spacing * Eigen::Vector3d(i, j, k);
  }
  /// The node opposite to the origin, length.                                                  [3]
  [[nodiscard]] Eigen::Vector3d last() const {
    return point(count.x() - 1, count.y() - 1, count.z() - 1);
  }
  friend bool operator==(const GridNodes& a, const GridNodes& b) {
    return a.origin == b.origin && a.spacing == b.spacing && a.count == b.count;
  }
};

/// The tricubic spline through values at the nodes of a grid: twice continuously differentiable
/// everywhere. Within the grid it is exact for cubic polynomials of each coordinate, and its error
/// is of order spacing⁴ where the interpolated function is smooth, spacing³ in the gradient,
/// spacing² in the Hessian (not-a-knot ends keep these orders up to the border). Outside it levels
/// off to a constant along each axis within two spacings. NaN in, NaN out.
class TricubicSpline {
 public:
  /// Value and first two derivatives at a point.
  struct Jet {
    double value = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< 1/length              [3]
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   ///< 1/length²             [3 x 3]
  };

  /// The spline through values.
  ///
  /// @param values  at the nodes, x runs fastest                                      [nodes]
  /// @throws InvalidInput if an axis has fewer than 4 nodes, or the number of values is not that of
  ///         the nodes
  [[nodiscard]] static TricubicSpline through(const GridNodes& nodes,
                                              const std::vector<double>& values);

  /// The spline with known coefficients.
  ///
  /// @param coefficients  of the B-splines centred at the nodes and at one more beyond each end of
  ///                      each axis, x runs fastest                               [Π(count + 2)]
  /// @throws InvalidInput as `through` does
  TricubicSpline(const GridNodes& nodes, std::vector<double> coefficients);

  /// @param x  a point, length                                                        [3]
  [[nodiscard]] double value(const Eigen::Vector3d& x) const;
  /// @param x  a point, length                                                        [3]
  [[nodiscard]] Jet jet(const Eigen::Vector3d& x) const;
  /// Derivative of the Hessian along a direction; jumps at the borders of cells.      [3 x 3]
  [[nodiscard]] Eigen::Matrix3d hessian_slope(const Eigen::Vector3d& x,
                                              const Eigen::Vector3d& direction) const;

  /// What it was constructed from.
  [[nodiscard]] const GridNodes& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<double>& coefficients() const { return coefficients_; }

 private:
  template <int kOrder>
  [[nodiscard]] auto derivatives(const Eigen::Vector3d& x) const;

  GridNodes nodes_;
  std::vector<double> coefficients_;
};

}  // namespace hbar
