#pragma once

#include "hbar/core/base/scalar.h"

namespace hbar::testing {

/// x + ε d, entry by entry.
template <typename X, typename D>
[[nodiscard]] auto with_slope(const Eigen::MatrixBase<X>& x, const Eigen::MatrixBase<D>& d) {
  Eigen::Matrix<Dual, X::RowsAtCompileTime, X::ColsAtCompileTime> out(x.rows(), x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      out(i, j) = Dual(x(i, j), d(i, j));
    }
  }
  return out;
}

/// The values a of a + b ε.
template <typename X>
[[nodiscard]] auto values(const Eigen::MatrixBase<X>& x) {
  return x.unaryExpr([](const Dual& entry) { return entry.value; }).eval();
}

/// The derivatives b of a + b ε.
template <typename X>
[[nodiscard]] auto slopes(const Eigen::MatrixBase<X>& x) {
  return x.unaryExpr([](const Dual& entry) { return entry.slope; }).eval();
}

/// ∂f/∂x, exact to rounding.                                                    [f x x]
///
/// @param f  from VectorX<Dual> to a vector of Dual
template <typename Function>
[[nodiscard]] Eigen::MatrixXd dual_jacobian(const Function& f, const Eigen::VectorXd& x) {
  Eigen::MatrixXd jacobian;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::VectorXd column =
        slopes(f(with_slope(x, Eigen::VectorXd(Eigen::VectorXd::Unit(x.size(), i)))));
    jacobian.conservativeResize(column.size(), x.size());
    jacobian.col(i) = column;
  }
  return jacobian;
}

}  // namespace hbar::testing
