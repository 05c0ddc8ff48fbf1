#pragma once

#include <algorithm>
#include <cmath>

#include "hbar/core/base/scalar.h"

namespace hbar::solvers {

/// Factors that scale each row's largest magnitude to between 1 and 2. Powers of two, so that
/// scaling causes no rounding.
///
/// @param largest  magnitude of each row; 0 gives 1                              [n]
/// @param scale    receives the factors                                          [n]
inline void set_power_of_two_scales(const Eigen::VectorXd& largest, Eigen::VectorXd& scale) {
  for (Eigen::Index i = 0; i < largest.size(); ++i) {
    scale[i] = largest[i] > 0.0 ? std::exp2(-std::max(std::ilogb(largest[i]), -1022)) : 1.0;
  }
}

}  // namespace hbar::solvers
