#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hbar::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Largest absolute entry, 0 of an empty matrix, NaN if any entry is.
template <typename Derived>
[[nodiscard]] double largest(const Eigen::MatrixBase<Derived>& m) {
  return m.size() == 0 ? 0.0 : m.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

/// Largest entry of a − b relative to the largest of b; NaN if either holds one, infinity where the
/// sizes differ.
template <typename A, typename B>
[[nodiscard]] double relative_gap(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) {
    return std::numeric_limits<double>::infinity();
  }
  const double gap = largest((a - b).eval());
  return gap == 0.0 ? 0.0 : gap / largest(b);
}

/// ∂f/∂x by central differences, extrapolated once: the error is of order h⁴.     [f x x]
template <typename Function>
[[nodiscard]] Eigen::MatrixXd differences(const Function& f, const Eigen::VectorXd& x,
                                          double h = 1e-3) {
  const auto central = [&](Eigen::Index i, double step) -> Eigen::VectorXd {
    Eigen::VectorXd ahead = x;
    Eigen::VectorXd behind = x;
    ahead[i] += step;
    behind[i] -= step;
    const Eigen::VectorXd f_ahead = f(ahead);
    const Eigen::VectorXd f_behind = f(behind);
    return (f_ahead - f_behind) / (ahead[i] - behind[i]);
  };
  Eigen::MatrixXd jacobian;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd column = (4.0 * central(i, 0.5 * h) - central(i, h)) / 3.0;
    jacobian.conservativeResize(column.size(), x.size());
    jacobian.col(i) = column;
  }
  return jacobian;
}

/// Slope of log |f(ε) − f(0) − ε f'(0)| over log ε: 2 where `derivative` is f'(0).
///
/// @param f          function of ε
/// @param largest_e  the first ε; four decades follow
template <typename Function>
[[nodiscard]] double taylor_slope(const Function& f, double derivative, double largest_e) {
  constexpr int kPoints = 9;
  const double f0 = f(0.0);
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const double e = largest_e * std::pow(10.0, -0.5 * k);
    const double x = std::log(e);
    const double y = std::log(std::abs(f(e) - f0 - e * derivative));
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (kPoints * sum_xy - sum_x * sum_y) / (kPoints * sum_xx - sum_x * sum_x);
}

}  // namespace hbar::testing
