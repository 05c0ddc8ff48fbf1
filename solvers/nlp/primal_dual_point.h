#pragma once

#include <Eigen/Core>

namespace hbar::solvers {

/// A point of a nonlinear program together with its multipliers, in the program's units. At an
/// optimum ∇f + (dc/dx)ᵀ λ − z_L + z_U = 0.
struct PrimalDualPoint {
  Eigen::VectorXd x;  ///< variables                                   [n]
  Eigen::VectorXd constraint_multipliers =
      {};                                  ///< λ: > 0 at an upper bound, < 0 at a lower one [m]
  Eigen::VectorXd lower_multipliers = {};  ///< z_L ≥ 0                                     [n]
  Eigen::VectorXd upper_multipliers = {};  ///< z_U ≥ 0                                     [n]
  double mu = 0.0;  ///< barrier parameter of an interior-point method there; 0: unknown
};

}  // namespace hbar::solvers
