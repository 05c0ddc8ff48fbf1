#include "hbar/core/geometry/tricubic_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

std::size_t to_size(Eigen::Index index) { return static_cast<std::size_t>(index); }

/// Nodes, or coefficients, of a grid.
std::size_t volume(const Eigen::Vector3i& count) {
  return to_size(count.x()) * to_size(count.y()) * to_size(count.z());
}

void check_grid(const GridNodes& nodes, const Eigen::Vector3i& expected, std::size_t found) {
  if (nodes.count.minCoeff() < 4) {
    throw InvalidInput(concat("tricubic spline: a grid of ", listed(nodes.count),
                              " nodes; at least 4 on each axis are needed"));
  }
  if (volume(expected) != found) {
    throw InvalidInput(concat("tricubic spline: ", found, " numbers for a grid of ",
                              listed(expected), "; ", volume(expected), " are needed"));
  }
}

/// Cubic B-spline coefficients c₋₁ … cₙ with (cᵢ₋₁ + 4 cᵢ + cᵢ₊₁)/6 = fᵢ. The not-a-knot condition
/// at the second node makes the fourth difference of c vanish there; with the equations of nodes 0,
/// 1 and 2 this gives c₁ = f₁ − (f₀ − 2 f₁ + f₂)/6. The other end is analogous; the rest is a
/// tridiagonal system, and c₀ and c₋₁ follow from the equations of nodes 1 and 0.
///
/// @param line  fᵢ at i + 1 on entry, cᵢ at i + 1 on return                          [n + 2]
/// @param ratio working memory                                                       [n + 2]
void interpolate_line(std::vector<double>& line, std::vector<double>& ratio) {
  const std::size_t last = line.size() - 2;  // place of the last node; the first one's is 1
  const double f0 = line[1];
  const double f1 = line[2];
  const double g0 = line[last];
  const double g1 = line[last - 1];
  const double c1 = f1 - (f0 - 2.0 * f1 + line[3]) / 6.0;
  const double d1 = g1 - (g0 - 2.0 * g1 + line[last - 2]) / 6.0;
  line[2] = c1;
  ratio[2] = 0.0;
  for (std::size_t i = 3; i < last - 1; ++i) {
    ratio[i] = 1.0 / (4.0 - ratio[i - 1]);
    line[i] = (6.0 * line[i] - line[i - 1]) * ratio[i];
  }
  line[last - 1] = d1;
  for (std::size_t i = last - 2; i > 2; --i) {
    line[i] -= ratio[i] * line[i + 1];
  }
  line[1] = 6.0 * f1 - 4.0 * c1 - line[3];
  line[0] = 6.0 * f0 - 4.0 * line[1] - c1;
  line[last] = 6.0 * g1 - 4.0 * d1 - line[last - 2];
  line[last + 1] = 6.0 * g0 - 4.0 * line[last] - d1;
}

/// Turns values into coefficients along one axis, on every line of a grid of coefficients.
void interpolate_axis(std::vector<double>& grid, const Eigen::Vector3i& count, int axis) {
  const std::array<std::size_t, 3> strides = {1, to_size(count.x()),
                                              to_size(count.x()) * to_size(count.y())};
  const std::size_t stride = strides[to_size(axis)];
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  std::vector<double> line(to_size(count[axis]));
  std::vector<double> ratio(line.size());
  for (int i = 0; i < count[u]; ++i) {
    for (int j = 0; j < count[v]; ++j) {
      const std::size_t first = to_size(i) * strides[to_size(u)] + to_size(j) * strides[to_size(v)];
      for (std::size_t k = 0; k < line.size(); ++k) {
        line[k] = grid[first + k * stride];
      }
      interpolate_line(line, ratio);
      for (std::size_t k = 0; k < line.size(); ++k) {
        grid[first + k * stride] = line[k];
      }
    }
  }
}

/// Weights of the four coefficients that contribute at a coordinate, for the value and its
/// derivatives.
struct AxisWeights {
  std::array<std::size_t, 4> places;             ///< on the axis, padding counted
  std::array<std::array<double, 4>, 4> weights;  ///< [derivative][coefficient], per spacing
};

/// @param t      coordinate in spacings from the first node
/// @param count  nodes of the axis
AxisWeights axis_weights(double t, int count) {
  // Further outside, all four places are the last one.
  const double inside = t < -3.0 ? -3.0 : (t > count + 1.0 ? count + 1.0 : t);
  const double cell = std::floor(inside);
  const double u = inside - cell;
  const double w = 1.0 - u;
  const int first = std::isnan(t) ? 0 : static_cast<int>(cell);
  AxisWeights axis = {};
  for (int i = 0; i < 4; ++i) {
    axis.places[to_size(i)] = to_size(std::clamp(first + i, 0, count + 1));
  }
  axis.weights[0] = {w * w * w / 6.0, 2.0 / 3.0 - u * u * (1.0 - u / 2.0),
                     2.0 / 3.0 - w * w * (1.0 - w / 2.0), u * u * u / 6.0};
  axis.weights[1] = {-w * w / 2.0, u * (1.5 * u - 2.0), w * (2.0 - 1.5 * w), u * u / 2.0};
  axis.weights[2] = {w, 3.0 * u - 2.0, 3.0 * w - 2.0, u};
  axis.weights[3] = {-1.0, 3.0, -3.0, 1.0};
  return axis;
}

}  // namespace

TricubicSpline TricubicSpline::through(const GridNodes& nodes, const std::vector<double>& values) {
  check_grid(nodes, nodes.count, values.size());
  const Eigen::Vector3i count = nodes.count.array() + 2;
  std::vector<double> grid(volume(count));
  auto value = values.begin();
  for (int k = 1; k <= nodes.count.z(); ++k) {
    for (int j = 1; j <= nodes.count.y(); ++j) {
      const std::size_t row = (to_size(k) * to_size(count.y()) + to_size(j)) * to_size(count.x());
      for (int i = 1; i <= nodes.count.x(); ++i) {
        grid[row + to_size(i)] = *value++;
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    interpolate_axis(grid, count, axis);
  }
  return {nodes, std::move(grid)};
}

TricubicSpline::TricubicSpline(const GridNodes& nodes, std::vector<double> coefficients)
    : nodes_(nodes), coefficients_(std::move(coefficients)) {
  check_grid(nodes_, nodes_.count.array() + 2, coefficients_.size());
}

/// All derivatives up to a total order, per spacing: [a][b][c] is ∂ᵃ⁺ᵇ⁺ᶜ/∂xᵃ∂yᵇ∂zᶜ. The sums are
/// taken axis by axis, so that each partial sum serves every derivative that needs it.
template <int kOrder>
auto TricubicSpline::derivatives(const Eigen::Vector3d& x) const {
  constexpr std::size_t kCount = kOrder + 1;
  const Eigen::Vector3d t = (x - nodes_.origin) / nodes_.spacing;
  const AxisWeights wx = axis_weights(t.x(), nodes_.count.x());
  const AxisWeights wy = axis_weights(t.y(), nodes_.count.y());
  const AxisWeights wz = axis_weights(t.z(), nodes_.count.z());
  const std::size_t row = to_size(nodes_.count.x()) + 2;
  const std::size_t slice = row * (to_size(nodes_.count.y()) + 2);

  std::array<std::array<std::array<double, kCount>, kCount>, kCount> result = {};
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<std::array<double, kCount>, kCount> in_slice = {};
    for (std::size_t j = 0; j < 4; ++j) {
      const double* const line = &coefficients_[wz.places[k] * slice + wy.places[j] * row];
      for (std::size_t a = 0; a < kCount; ++a) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
          sum += wx.weights[a][i] * line[wx.places[i]];
        }
        for (std::size_t b = 0; a + b < kCount; ++b) {
          in_slice[a][b] += wy.weights[b][j] * sum;
        }
      }
    }
    for (std::size_t a = 0; a < kCount; ++a) {
      for (std::size_t b = 0; a + b < kCount; ++b) {
        for (std::size_t c = 0; a + b + c < kCount; ++c) {
          result[a][b][c] += wz.weights[c][k] * in_slice[a][b];
        }
      }
    }
  }
  return result;
}

double TricubicSpline::value(const Eigen::Vector3d& x) const { return derivatives<0>(x)[0][0][0]; }

TricubicSpline::Jet TricubicSpline::jet(const Eigen::Vector3d& x) const {
  const auto D = derivatives<2>(x);
  Jet jet;
  jet.value = D[0][0][0];
  jet.gradient << D[1][0][0], D[0][1][0], D[0][0][1];
  jet.hessian << D[2][0][0], D[1][1][0], D[1][0][1],  //
      D[1][1][0], D[0][2][0], D[0][1][1],             //
      D[1][0][1], D[0][1][1], D[0][0][2];
  jet.gradient /= nodes_.spacing;
  jet.hessian /= nodes_.spacing * nodes_.spacing;
  return jet;
}

Eigen::Matrix3d TricubicSpline::hessian_slope(const Eigen::Vector3d& x,
                                              const Eigen::Vector3d& direction) const {
  const auto D = derivatives<3>(x);
  const double h = nodes_.spacing;
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        std::array<std::size_t, 3> order = {};
        for (const int axis : {i, j, k}) {
          ++order[to_size(axis)];
        }
        slope(i, j) += D[order[0]][order[1]][order[2]] * direction[k] / (h * h * h);
      }
    }
  }
  return slope;
}

}  // namespace hbar
