#pragma once

#include <limits>
#include <string>

#include "hbar/adjoint/terms/constraint.h"
#include "hbar/adjoint/terms/objective.h"

namespace hbar {

/// How far a term's partials differ from differences of its values, and its second partials from
/// differences of its partials.
///
/// Each number is varied in units of the largest value of its row over time (1 if all are zero).
struct TermCheck {
  /// Largest |central difference − partial|, over the norm of its row's partials.
  double gap = 0.0;
  std::string gap_name;  ///< "power by u 0 at step 2"; empty if gap is 0
  /// Order in ε of c(x + ε δ) − c − ε c' δ along a direction that changes every number: 2 if the
  /// partials are right; infinite if the remainder is only rounding, as for linear rows.
  double slope = std::numeric_limits<double>::infinity();
  bool has_second = false;  ///< the term has second partials; otherwise the rest means nothing
  /// Largest |central difference of a partial − second partial| over the norm of its row's second
  /// partials: over all pairs of numbers, so that an undeclared pair shows up too.
  double second_gap = 0.0;
  std::string second_gap_name;  ///< "power by u 0 at step 2 and qdot 6 at step 3"
  /// Order in ε of the difference between c(x + ε δ) and its quadratic model: 3 if all partials are
  /// right; infinite if the remainder is only rounding.
  double second_slope = std::numeric_limits<double>::infinity();
  /// Entries of which no difference is exact enough to tell, at any step: they count in no gap.
  int unresolved = 0;
  int repeated = 0;  ///< pairs that second_places lists more than once
  int idle = 0;      ///< listed pairs whose second partial is zero at these values

  /// Gaps below 1e-6, slopes at least 1.9 and 2.9, nothing repeated. Idle pairs only cost time.
  [[nodiscard]] bool passed() const;
};

/// Compares a term's partials and second partials with differences of its values and partials.
/// Steps are as small as each entry needs, so that terms that saturate, or grow fast, are judged
/// rightly, too. Costs up to thirty evaluations of the term per number: meant for small made-up
/// values.
///
/// @param values  where to check, away from kinks; any numbers of a trajectory's shape
/// @throws InvalidInput if the term reads a number that the values do not contain
[[nodiscard]] TermCheck check_objective_term(const ObjectiveTerm& term,
                                             const TrajectoryValues& values);
[[nodiscard]] TermCheck check_constraint_term(const ConstraintTerm& term,
                                              const TrajectoryValues& values);

}  // namespace hbar
