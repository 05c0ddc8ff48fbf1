#pragma once

#include "hbar/core/base/scalar.h"

namespace hbar {

/// value + ε slope, entry by entry, from two vectors or matrices of equal shape.
template <typename Value, typename Slope>
[[nodiscard]] MatrixX<Dual> dual_matrix(const Eigen::MatrixBase<Value>& value,
                                        const Eigen::MatrixBase<Slope>& slope) {
  return value.binaryExpr(slope, [](double v, double s) { return Dual(v, s); });
}
[[nodiscard]] inline VectorX<Dual> dual_vector(const Eigen::Ref<const Eigen::VectorXd>& value,
                                               const Eigen::Ref<const Eigen::VectorXd>& slope) {
  return dual_matrix(value, slope);
}

/// Slopes, entry by entry.
template <typename Duals>
[[nodiscard]] auto slopes_of(const Eigen::MatrixBase<Duals>& duals) {
  return duals.unaryExpr([](const Dual& x) { return x.slope; });
}

}  // namespace hbar
