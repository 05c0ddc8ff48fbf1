#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>

#include "hbar/solvers/nlp/nlp.h"

namespace hbar::solvers {

/// How thoroughly derivatives are checked.
struct GradientCheckOptions {
  int directions = 3;       ///< random directions, for differences and for the remainder
  bool coordinates = true;  ///< also each variable by itself
  std::uint64_t seed = 1;   ///< of the random directions
};

/// How far the derivatives of a nonlinear program differ from differences of its values. Only what
/// exceeds the rounding errors of the differences counts.
struct GradientCheck {
  /// Largest |difference − derivative| of an output along a direction, over the largest
  /// derivative of that output; the smallest over several steps is taken.
  double gap = 0.0;
  std::string gap_name;  ///< "objective by length", "mass along direction 2"; empty if gap is 0
  /// Smallest Taylor slope: the order in ε of f(x+εd) − f(x) − εf'd, 2 if f' is right and 1 if it
  /// is not; infinite if every remainder is only rounding, as for linear functions.
  double slope = std::numeric_limits<double>::infinity();
  std::string slope_name;  ///< "mass along direction 2"; empty if slope is infinite
};

/// Compares the objective's gradient and the constraints' Jacobian with differences.
///
/// Steps are in units of the variables' scale, up to 1e-2; those at which the program cannot be
/// evaluated are skipped. Values and derivatives are evaluated at x once.
///
/// @param nlp      the program
/// @param x        where to check; steps may leave the bounds  [n]
/// @param options  see there
/// @throws InvalidInput if the program is inconsistent or x has another size
/// @throws EvaluationError if x itself, or every step of a direction, cannot be evaluated
[[nodiscard]] GradientCheck check_gradients(Nlp& nlp, const Eigen::VectorXd& x,
                                            const GradientCheckOptions& options = {});

}  // namespace hbar::solvers
