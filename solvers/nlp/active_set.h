#pragma once

#include <Eigen/Core>
#include <vector>

#include "hbar/solvers/nlp/primal_dual_point.h"
#include "hbar/solvers/nlp/scaled_nlp.h"

namespace hbar::solvers {

/// Which bound a variable or a constraint lies on.
enum class Activity {
  kInactive,
  kLower,
  kUpper,
  kEqual  ///< lower = upper: a fixed variable, an equation
};

/// Which bounds a point lies on.
struct ActiveSet {
  std::vector<Activity> variables;    ///< [n]
  std::vector<Activity> constraints;  ///< [m]
};

/// The bounds that a point lies on, or beyond.
///
/// @param program    supplies the bounds
/// @param x          scaled variables                            [n]
/// @param c          scaled constraints                          [m]
/// @param tolerance  distance from a bound, in typical sizes, that counts as on it
[[nodiscard]] ActiveSet find_active_set(const ScaledNlp& program, const Eigen::VectorXd& x,
                                        const Eigen::VectorXd& c, double tolerance);

/// An active constraint whose gradient is a combination of other active constraints' gradients.
struct Dependence {
  int constraint = 0;
  std::vector<int> others;  ///< constraints of that combination; empty if the gradient is zero
};

/// The multipliers that a point given without any must have if it is an optimum.
struct MultiplierEstimate {
  ActiveSet active;
  /// Scaled; multipliers of the wrong sign, and those of inactive constraints, are zero.
  PrimalDualPoint point;
  double stationarity = 0.0;  ///< ‖∇L‖∞ in scaled units; 0 at an optimum
  /// False if there were too many active constraints (over 10⁶ entries in their dense Jacobian):
  /// their multipliers are then zero, and dependences unknown.
  bool examined = true;
  std::vector<Dependence> dependences;  ///< with respect to the free variables, those on no bound
};

/// The least-squares multipliers of the active constraints, by a dense QR decomposition.
///
/// @param program    evaluated at x
/// @param x          scaled variables                                [n]
/// @param tolerance  as of find_active_set
/// @throws EvaluationError if x cannot be evaluated
/// @throws whatever the program throws
[[nodiscard]] MultiplierEstimate estimate_multipliers(ScaledNlp& program, const Eigen::VectorXd& x,
                                                      double tolerance);

/// The gradient of the Lagrangian, ∇f + (dc/dx)ᵀ λ − z_L + z_U, in scaled units.
///
/// @param program  evaluated at point.x
/// @param point    scaled
/// @returns        [n]
/// @throws EvaluationError if x cannot be evaluated
/// @throws whatever the program throws
[[nodiscard]] Eigen::VectorXd lagrangian_gradient(ScaledNlp& program, const PrimalDualPoint& point);

}  // namespace hbar::solvers
