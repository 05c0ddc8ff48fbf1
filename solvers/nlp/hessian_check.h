#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "hbar/solvers/nlp/gradient_check.h"
#include "hbar/solvers/nlp/nlp.h"

namespace hbar::solvers {

/// How far the Hessian of a program's Lagrangian differs from differences of its gradients and
/// values. Only what exceeds the rounding errors of the differences counts.
struct HessianCheck {
  /// Largest |difference of ∇L − H d| of an entry along a direction, over the largest entry of H
  /// in that row; the smallest over several steps is taken.
  double gap = 0.0;
  std::string gap_name;  ///< "length along direction 1", "length by mass"; empty if gap is 0
  /// Smallest Taylor slope: the order in ε of L(x+εd) − L − ε∇Lᵀd − ε²dᵀHd/2, 3 if ∇L and H are
  /// right and 2 if only ∇L is; infinite if every remainder is only rounding.
  double slope = std::numeric_limits<double>::infinity();
  std::string slope_name;  ///< "direction 2"; empty if slope is infinite
};

/// Compares the exact Hessian of L = σ f + λᵀ c with differences, for random multipliers: σ between
/// 1/2 and 3/2, λ between ± 1 over the constraints' scales.
///
/// Steps are in units of the variables' scale, up to 1e-2; those at which the program cannot be
/// evaluated are skipped. The Hessian is evaluated at x once.
///
/// @param nlp      the program, with a Hessian of kind kExact
/// @param x        where to check; steps may leave the bounds  [n]
/// @param options  see there
/// @throws InvalidInput if the program is inconsistent, has no exact Hessian, or x has another size
/// @throws EvaluationError if x itself, or every step of a direction, cannot be evaluated
[[nodiscard]] HessianCheck check_hessian(Nlp& nlp, const Eigen::VectorXd& x,
                                         const GradientCheckOptions& options = {});

}  // namespace hbar::solvers
