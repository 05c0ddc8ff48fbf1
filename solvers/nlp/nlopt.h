#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include "hbar/solvers/nlp/nlp.h"
#include "hbar/solvers/nlp/nlp_evaluator.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::solvers {

/// The supported methods of NLopt.
enum class NloptAlgorithm {
  kLbfgs,  ///< limited-memory BFGS with bounds, without constraints (L. Luksan's code)
  kSlsqp   ///< sequential quadratic programming with bounds and constraints (D. Kraft's code);
           ///< dense: time grows with n³, memory with n²
};

/// One evaluation of the objective; NLopt does not say which of them it accepts.
struct NloptEvaluation {
  int evaluation = 0;      ///< from 1
  double objective = 0.0;  ///< f
  double elapsed = 0.0;    ///< wall time since the start, s
};

/// Options for NLopt. Tolerances are in units of the scales of variables, constraints and
/// objective.
struct NloptOptions {
  NloptAlgorithm algorithm = NloptAlgorithm::kLbfgs;
  double optimality_tolerance = 1e-6;  ///< largest entry of the Lagrangian's gradient at an optimum
  double constraint_tolerance = 1e-6;  ///< largest violation of a feasible point
  double objective_tolerance =
      1e-14;                          ///< stops when a step changes the objective by less; 0: never
  double variable_tolerance = 1e-12;  ///< stops when a step changes every variable by less
  int max_evaluations = 10000;        ///< of the objective
  double max_wall_time = std::numeric_limits<double>::infinity();  ///< s
  int memory = 0;                ///< vector pairs that kLbfgs keeps; 0: NLopt's choice
  double objective_scale = 1.0;  ///< typical size > 0 of the objective
  /// Called after every evaluation; returning false stops. Exceptions propagate out of
  /// minimise_with_nlopt.
  std::function<bool(const NloptEvaluation&)> on_evaluation = {};
  /// Stops soon after it becomes true (a signal handler may set it); may be null.
  const std::atomic<bool>* stop = nullptr;
};

/// How a minimisation ended.
enum class NloptStatus {
  kOptimal,           ///< feasible and stationary within the tolerances
  kStalled,           ///< steps became too small before reaching that
  kRounding,          ///< rounding errors prevent further progress
  kInterrupted,       ///< the stop flag was set
  kStopped,           ///< the callback returned false
  kEvaluationLimit,   ///< max_evaluations
  kTimeLimit,         ///< max_wall_time
  kEvaluationFailed,  ///< the start, or everything near it, cannot be evaluated
  kOutOfMemory,
  kFailed  ///< anything else
};

/// "optimal", "stalled", …
[[nodiscard]] std::string_view to_string(NloptStatus status);

/// What to try after a minimisation that ended this way; empty after an optimum.
[[nodiscard]] std::string_view advice(NloptStatus status);

/// The result of a minimisation: the best feasible point evaluated, or the least infeasible one.
struct NloptResult {
  NloptStatus status = NloptStatus::kFailed;
  std::string message;        ///< how it ended, what was reached and what to try
  bool feasible = false;      ///< violation.relative ≤ constraint_tolerance
  Eigen::VectorXd x;          ///< variables                                         [n]
  Eigen::VectorXd c;          ///< constraints at x                                  [m]
  double objective = 0.0;     ///< f(x)
  Violation violation;        ///< the largest of constraints and bounds
  double stationarity = 0.0;  ///< largest entry of the Lagrangian's gradient, in scales
  /// Least-squares multipliers at x (NLopt gives none), see estimate_multipliers.
  Eigen::VectorXd constraint_multipliers;  ///< λ                                     [m]
  Eigen::VectorXd lower_multipliers;       ///< z_L ≥ 0                               [n]
  Eigen::VectorXd upper_multipliers;       ///< z_U ≥ 0                               [n]
  EvaluationCounts evaluations;
  double elapsed = 0.0;  ///< wall time, s

  [[nodiscard]] bool converged() const { return status == NloptStatus::kOptimal; }
  /// x with its multipliers.
  [[nodiscard]] PrimalDualPoint point() const {
    return {x, constraint_multipliers, lower_multipliers, upper_multipliers};
  }
};

/// Minimises a nonlinear program with NLopt (LGPL; target hbar::nlopt), 2.6 or newer.
///
/// NLopt's own status only says that steps became small; whether a point is an optimum is decided
/// here, from the Lagrangian's gradient. Where the program cannot be evaluated, NLopt receives a
/// value above all seen so far, so that its line search shortens the step. Calls from several
/// threads are independent.
///
/// @param nlp      the program
/// @param options  see there
/// @returns how it ended and the best point; always look at converged()
/// @throws InvalidInput if the program is inconsistent (see validate), has constraints that
///   kLbfgs cannot take, or an option is out of its range
/// @throws whatever the program (other than EvaluationError) or the callback throws
[[nodiscard]] NloptResult minimise_with_nlopt(Nlp& nlp, const NloptOptions& options = {});

}  // namespace hbar::solvers
