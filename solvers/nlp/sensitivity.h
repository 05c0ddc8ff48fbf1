#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"
#include "hbar/solvers/nlp/active_set.h"

namespace hbar::solvers {

/// How sensitivities are computed.
struct SensitivityOptions {
  /// A point this close to a bound counts as on it; a bound whose multiplier exceeds this is held;
  /// at an optimum the Lagrangian's gradient and the violations are below it. In units of the
  /// scales.
  double tolerance = 1e-4;
  double objective_scale = 1.0;  ///< typical size > 0 of the objective
  SolverFactory solver = {};     ///< for the KKT system; null: default_solver(), which is KLU here
};

/// How an optimum changes with the values at which some variables θ are fixed, in the program's
/// units.
struct Sensitivity {
  Eigen::MatrixXd dx_dtheta;  ///< variables; rows of θ are the identity, of held ones zero [n x p]
  Eigen::MatrixXd
      dlambda_dtheta;         ///< multipliers of constraints; zero where inactive       [m x p]
  Eigen::VectorXd df_dtheta;  ///< objective                                             [p]
  /// What is held: equations, fixed variables, and bounds whose multiplier is positive.
  ActiveSet held;
  /// Variables and constraints that lie on a bound with a negligible multiplier: there the optimum
  /// has a kink, and the derivatives hold on the side where they leave the bound.
  std::vector<std::string> weakly_active;
};

/// Derivatives of an optimum with respect to fixed variables.
///
/// With the active set held, the optimality conditions are differentiated (implicit function
/// theorem; A. V. Fiacco, Introduction to Sensitivity and Stability Analysis in Nonlinear
/// Programming, 1983):
///
///     [ H_ff  A_fᵀ ] [ dx_f/dθ ]     [ H_fθ ]
///     [ A_f   0    ] [ dλ/dθ   ] = − [ A_θ  ],     df/dθ = ∂L/∂θ,
///
/// H the Hessian of the Lagrangian, A the held constraints' Jacobian, f the variables that are not
/// held. The system is equilibrated and solved once per entry of θ, with one factorisation.
///
/// @param nlp      with a Hessian of kind kExact; its start is not used
/// @param optimum  with its multipliers; a converged result's point()
/// @param theta    indices of variables with lower = upper  [p]
/// @param options  see there
/// @throws InvalidInput if the program is inconsistent or has no exact Hessian, sizes disagree, or
///   an index of theta is out of range, repeated, or not that of a fixed variable
/// @throws NumericalFailure if the point is not an optimum, or the KKT matrix is singular: the held
///   constraints are dependent, or leave a direction in which the Lagrangian is flat
/// @throws EvaluationError if the program cannot be evaluated there
[[nodiscard]] Sensitivity sensitivity_of_optimum(Nlp& nlp, const PrimalDualPoint& optimum,
                                                 const std::vector<int>& theta,
                                                 const SensitivityOptions& options = {});

}  // namespace hbar::solvers
