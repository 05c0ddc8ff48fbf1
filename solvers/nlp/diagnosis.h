#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hbar/solvers/nlp/active_set.h"
#include "hbar/solvers/nlp/nlp.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::solvers {

/// Thresholds of a diagnosis, in units of the scales.
struct DiagnosisOptions {
  double tolerance = 1e-6;             ///< distance from a bound that counts as on it; violation
  double optimality_tolerance = 1e-5;  ///< gradient of the Lagrangian that counts as an optimum's
  double objective_scale = 1.0;        ///< typical size > 0 of the objective
};

/// A constraint or variable that lies on a bound; numbers in the program's units.
struct ActiveBound {
  std::string name;
  Activity activity = Activity::kInactive;  ///< which bound
  double value = 0.0;                       ///< of the constraint or variable
  double bound = 0.0;
  double multiplier = 0.0;  ///< of the bound, in units of f per unit: by how much f would fall if
                            ///< the bound were moved outwards; of either sign for equations
};

/// An active constraint whose gradient is a combination of other active ones'.
struct DependentConstraint {
  std::string name;
  std::vector<std::string> others;  ///< empty: no free variable moves the constraint at all
};

/// The state of a point of a program: what holds it, what is wrong with it, what to try.
struct Diagnosis {
  std::string outcome;      ///< what the optimiser said; may be empty
  double objective = 0.0;   ///< f
  Violation violation;      ///< the worst of constraints and bounds
  double stationarity = 0;  ///< largest entry of the Lagrangian's gradient, in units of the scales
  std::string least_stationary;          ///< its variable; empty if stationarity is 0
  std::vector<ActiveBound> constraints;  ///< active ones, equations among them
  std::vector<ActiveBound> variables;    ///< on a bound; those with lower = upper are not listed
  bool dependences_known = true;         ///< false if there were too many to examine
  std::vector<DependentConstraint> dependent;
  std::vector<std::string> advice;  ///< what to try, most important first; empty at an optimum

  /// All of it as text of several lines; of many active bounds, the ten with the largest
  /// multipliers.
  [[nodiscard]] std::string text() const;
};

/// Examines a point.
///
/// @param nlp      the program, evaluated at the point
/// @param point    multipliers may be missing; reports these or the least-squares ones, whichever
///                 leave the smaller gradient of the Lagrangian
/// @param outcome  what the optimiser said
/// @param options  see there
/// @throws InvalidInput if the program is inconsistent or sizes disagree
/// @throws EvaluationError if the point cannot be evaluated
[[nodiscard]] Diagnosis diagnose_point(Nlp& nlp, const PrimalDualPoint& point,
                                       const std::string& outcome = {},
                                       const DiagnosisOptions& options = {});

/// Examines an optimiser's result: an IpoptResult or an NloptResult.
template <typename Result>
[[nodiscard]] Diagnosis diagnose(Nlp& nlp, const Result& result,
                                 const DiagnosisOptions& options = {}) {
  return diagnose_point(nlp, result.point(), result.message, options);
}

}  // namespace hbar::solvers
