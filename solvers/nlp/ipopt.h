#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hbar/solvers/nlp/nlp.h"
#include "hbar/solvers/nlp/nlp_evaluator.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::solvers {

/// One accepted iterate of Ipopt, as in its own table of iterations.
struct IterationInfo {
  int iteration = 0;                ///< from 0, the start
  bool restoring = false;           ///< in the feasibility restoration phase
  double objective = 0.0;           ///< f, unscaled
  double primal_infeasibility = 0;  ///< largest violation of the constraints, Ipopt's scale
  double dual_infeasibility = 0.0;  ///< largest entry of the Lagrangian's gradient, Ipopt's scale
  double mu = 0.0;                  ///< barrier parameter
  double step_norm = 0.0;           ///< ‖d‖∞ of the primal step, in Ipopt's scaled variables
  double alpha_primal = 0.0;        ///< fraction of the primal step taken
  double regularization = 0.0;      ///< of the Hessian; 0: none
  int line_search_trials = 0;       ///< points tried for this step
  double elapsed = 0.0;             ///< wall time since the start, s
};

struct IpoptResult;

/// Options for Ipopt.
struct IpoptOptions {
  double tolerance = 1e-8;  ///< scaled optimality error of an optimum
  /// Largest violation of a feasible point, in units of the constraints' scale.
  double constraint_tolerance = 1e-6;
  double acceptable_tolerance = 1e-6;  ///< optimality error accepted if no progress is made
  int max_iterations = 500;
  double max_wall_time = std::numeric_limits<double>::infinity();  ///< s
  /// kExact and kGaussNewton ask the program; kLimitedMemory is Ipopt's L-BFGS.
  HessianKind hessian = HessianKind::kLimitedMemory;
  double objective_scale = 1.0;  ///< typical size > 0 of the objective; Ipopt sees f over it
  /// Where to begin instead of NlpVariables::start, for example an earlier result's point(). Ipopt
  /// then starts with these multipliers and this barrier parameter (1e-6 if mu is 0), and moves the
  /// point away from its bounds by no more than 1e-9.
  std::optional<PrimalDualPoint> warm_start = {};
  int print_level = 0;  ///< 0: silent; 1 to 12: Ipopt writes to standard output

  /// Further options under Ipopt's names; they take precedence over those above.
  std::map<std::string, std::string> string_options = {};
  std::map<std::string, double> number_options = {};
  std::map<std::string, int> integer_options = {};

  /// Called at every iterate; returning false stops. Exceptions propagate out of solve_with_ipopt.
  std::function<bool(const IterationInfo&)> on_iteration = {};
  /// Called as soon as a point was evaluated and then whenever checkpoint_every has passed, between
  /// evaluations and iterates, with what the result would be if Ipopt were interrupted now.
  /// Exceptions propagate out of solve_with_ipopt.
  std::function<void(const IpoptResult&)> on_checkpoint = {};
  double checkpoint_every = 10.0;  ///< ≥ 0, s; 0: at every evaluation
  /// Stops soon after it becomes true (a signal handler may set it); may be null.
  const std::atomic<bool>* stop = nullptr;
};

/// An option that Ipopt knows, under the name that the maps of IpoptOptions take.
struct IpoptOptionInfo {
  std::string name;
  std::string description;  ///< one line; Ipopt leaves some empty
  /// Ipopt's default; its type tells which map the option belongs in.
  std::variant<std::string, double, int> default_value;
};

/// Every option of the linked Ipopt, by name.
[[nodiscard]] std::vector<IpoptOptionInfo> known_ipopt_options();

/// How an optimisation ended.
enum class IpoptStatus {
  kOptimal,            ///< within the tolerance
  kAcceptable,         ///< within the acceptable tolerance
  kFeasible,           ///< a square system was solved: feasible, nothing to optimise
  kInterrupted,        ///< the stop flag was set
  kStopped,            ///< the iteration callback returned false
  kIterationLimit,     ///< max_iterations
  kTimeLimit,          ///< max_wall_time
  kInfeasible,         ///< Ipopt converged to a point of locally least infeasibility
  kStepTooSmall,       ///< the search direction became too small
  kDiverging,          ///< the variables grow without bound
  kRestorationFailed,  ///< no feasible point was found on the way
  kStepFailed,         ///< the linear system of a step could not be solved
  kEvaluationFailed,   ///< a function failed where Ipopt needed its value
  kTooFewVariables,    ///< more equations than free variables
  kOutOfMemory,
  kInternalError,  ///< anything else
};

/// "optimal", "iteration limit", …
[[nodiscard]] std::string_view to_string(IpoptStatus status);

/// What to try after an optimisation that ended this way; empty after an optimum.
[[nodiscard]] std::string_view advice(IpoptStatus status);

/// The result of an optimisation. If Ipopt did not converge, x is the best feasible point
/// evaluated, or the least infeasible one if none was feasible.
struct IpoptResult {
  IpoptStatus status = IpoptStatus::kInternalError;
  std::string message;     ///< how it ended, what was reached and what to try
  bool feasible = false;   ///< violation.relative ≤ constraint_tolerance
  Eigen::VectorXd x;       ///< variables                                       [n]
  Eigen::VectorXd c;       ///< constraints at x                                [m]
  double objective = 0.0;  ///< f(x)
  Violation violation;     ///< the largest of constraints and bounds
  /// Multipliers of Ipopt's last iterate, with ∇f + (dc/dx)ᵀ λ − z_L + z_U = 0 at an optimum.
  Eigen::VectorXd constraint_multipliers;  ///< λ                                   [m]
  Eigen::VectorXd lower_multipliers;       ///< z_L ≥ 0                             [n]
  Eigen::VectorXd upper_multipliers;       ///< z_U ≥ 0                             [n]
  double mu = 0.0;                         ///< barrier parameter of the last iterate
  int iterations = 0;
  EvaluationCounts evaluations;
  double elapsed = 0.0;  ///< wall time, s

  /// Whether x is a local optimum, to the tolerance or the acceptable one.
  [[nodiscard]] bool converged() const {
    return status == IpoptStatus::kOptimal || status == IpoptStatus::kAcceptable;
  }
  /// x with its multipliers: what warm_start takes.
  [[nodiscard]] PrimalDualPoint point() const {
    return {x, constraint_multipliers, lower_multipliers, upper_multipliers, mu};
  }
};

/// Minimises a nonlinear program with Ipopt (EPL; target hbar::ipopt), 3.11 or newer.
///
/// Variables, constraints and the objective are divided by their scales for Ipopt; everything in
/// the options, the callback and the result is in the program's own units unless it says otherwise.
/// Optimisations in several threads are serialised, because Ipopt with MUMPS is not reentrant; the
/// program and the callback must not call solve_with_ipopt themselves. No file ipopt.opt is read.
///
/// @param nlp      the program
/// @param options  see there
/// @returns how it ended and the best point; always look at converged()
/// @throws InvalidInput if the program is inconsistent (see validate), has no Hessian of the
///   requested kind, the warm start has the wrong size, or an option is unknown or has a value that
///   Ipopt does not allow
/// @throws whatever the program (other than EvaluationError) or the callback throws
[[nodiscard]] IpoptResult solve_with_ipopt(Nlp& nlp, const IpoptOptions& options = {});

}  // namespace hbar::solvers
