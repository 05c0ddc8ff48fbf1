#include "hbar/solvers/nlp/diagnosis.h"

#include <algorithm>
#include <cmath>

namespace hbar::solvers {
namespace {

constexpr std::size_t kShown = 10;

const std::string& name_at(const std::vector<std::string>& names, Eigen::Index i) {
  return names[static_cast<std::size_t>(i)];
}

template <typename Limits>
ActiveBound active_bound(const Limits& limits, Activity activity, Eigen::Index i, double value,
                         double multiplier) {
  const double bound = activity == Activity::kUpper ? limits.upper[i] : limits.lower[i];
  return {name_at(limits.names, i), activity, value, bound, multiplier};
}

void list_active(const Nlp& nlp, const ActiveSet& active, const PrimalDualPoint& point,
                 const Eigen::VectorXd& c, Diagnosis& d) {
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const Activity activity = active.constraints[static_cast<std::size_t>(i)];
    if (activity == Activity::kInactive) {
      continue;
    }
    const double lambda = point.constraint_multipliers[i];
    d.constraints.push_back(active_bound(nlp.constraint_limits(), activity, i, c[i],
                                         activity == Activity::kLower ? -lambda : lambda));
  }
  for (Eigen::Index i = 0; i < point.x.size(); ++i) {
    const Activity activity = active.variables[static_cast<std::size_t>(i)];
    if (activity == Activity::kInactive || activity == Activity::kEqual) {
      continue;
    }
    d.variables.push_back(active_bound(
        nlp.variables(), activity, i, point.x[i],
        activity == Activity::kLower ? point.lower_multipliers[i] : point.upper_multipliers[i]));
  }
}

void advise(const Nlp& nlp, const DiagnosisOptions& options, const ActiveSet& active,
            Diagnosis& d) {
  const bool infeasible = d.violation.relative > options.tolerance;
  if (infeasible) {
    d.advice.push_back(concat("relax the bounds of ", d.violation.name,
                              ", check its derivatives (check_gradients), or start elsewhere"));
  }
  for (const DependentConstraint& constraint : d.dependent) {
    if (d.advice.size() >= kShown) {
      break;
    }
    if (constraint.others.empty()) {
      d.advice.push_back(concat("no free variable moves ", constraint.name,
                                " here: free one that does, or remove the constraint"));
    } else {
      d.advice.push_back(concat("remove ", constraint.name, " or a constraint it depends on"));
    }
  }
  const bool any_free = std::find(active.variables.begin(), active.variables.end(),
                                  Activity::kInactive) != active.variables.end();
  if (!any_free) {
    d.advice.emplace_back("every variable is on a bound: widen some");
  }
  if (d.stationarity > options.optimality_tolerance) {
    d.advice.push_back(concat("the gradient by ", d.least_stationary,
                              " is not balanced: optimise further from here, check the ",
                              "derivatives (check_gradients), and scale the variables",
                              nlp.variables().scale.size() == 0 ? " (they have no scale)" : ""));
  }
}

const char* words(Activity activity) {
  switch (activity) {
    case Activity::kLower:
      return "lower bound";
    case Activity::kUpper:
      return "upper bound";
    case Activity::kEqual:
      return "equation";
    case Activity::kInactive:
      return "no bound";
  }
  return "";
}

/// "2 active constraints:" and a line for each of the most important.
std::string list_in_words(const char* title, std::vector<ActiveBound> bounds) {
  if (bounds.empty()) {
    return concat("no ", title, "\n");
  }
  // Bounds before equations, which hold anyway.
  std::stable_sort(bounds.begin(), bounds.end(), [](const ActiveBound& a, const ActiveBound& b) {
    const bool a_last = a.activity == Activity::kEqual;
    const bool b_last = b.activity == Activity::kEqual;
    if (a_last != b_last) {
      return b_last;
    }
    return std::abs(a.multiplier) > std::abs(b.multiplier);
  });
  std::string result = concat(bounds.size(), " ", title, ":\n");
  for (std::size_t k = 0; k < std::min(bounds.size(), kShown); ++k) {
    const ActiveBound& b = bounds[k];
    result += concat("  ", b.name, " = ", b.value, ", ", words(b.activity), " ", b.bound,
                     ", multiplier ", b.multiplier, "\n");
  }
  if (bounds.size() > kShown) {
    result += concat("  and ", bounds.size() - kShown, " more\n");
  }
  return result;
}

}  // namespace

Diagnosis diagnose_point(Nlp& nlp, const PrimalDualPoint& point, const std::string& outcome,
                         const DiagnosisOptions& options) {
  validate(nlp);
  ScaledNlp program(nlp, options.tolerance, options.objective_scale);
  const PrimalDualPoint given = program.scaled(point);
  const MultiplierEstimate estimate = estimate_multipliers(program, given.x, options.tolerance);
  const double given_gap = lagrangian_gradient(program, given).lpNorm<Eigen::Infinity>();
  const PrimalDualPoint& chosen = given_gap < estimate.stationarity ? given : estimate.point;

  Diagnosis d;
  d.outcome = outcome;
  const Eigen::VectorXd gap = lagrangian_gradient(program, chosen).cwiseAbs();
  Eigen::Index worst = 0;
  d.stationarity = gap.maxCoeff(&worst);
  if (d.stationarity > 0.0) {
    d.least_stationary = name_at(nlp.variables().names, worst);
  }

  const PrimalDualPoint unscaled = program.unscaled(chosen);
  const double* f = program.evaluator().objective(unscaled.x);
  if (f == nullptr) {
    program.throw_failure("diagnosis");
  }
  d.objective = *f;
  const Eigen::VectorXd* c = program.evaluator().constraints(unscaled.x);
  if (c == nullptr) {
    program.throw_failure("diagnosis");
  }
  d.violation = largest_violation(nlp, point.x, *c);
  list_active(nlp, estimate.active, unscaled, *c, d);

  d.dependences_known = estimate.examined;
  const std::vector<std::string>& names = nlp.constraint_limits().names;
  for (const Dependence& dependence : estimate.dependences) {
    DependentConstraint constraint{name_at(names, dependence.constraint), {}};
    for (const int other : dependence.others) {
      constraint.others.push_back(name_at(names, other));
    }
    d.dependent.push_back(std::move(constraint));
  }
  advise(nlp, options, estimate.active, d);
  return d;
}

std::string Diagnosis::text() const {
  std::string result = outcome.empty() ? "" : outcome + "\n";
  result += concat("objective ", objective, ", gradient of the Lagrangian ", stationarity);
  if (!least_stationary.empty()) {
    result += concat(" (by ", least_stationary, ")");
  }
  result += "\n";
  if (violation.amount > 0.0) {
    result += concat("worst violation: ", violation.name, " by ", violation.amount, "\n");
  } else {
    result += "nothing is violated\n";
  }
  result += list_in_words("active constraints", constraints);
  result += list_in_words("variables on a bound", variables);
  if (!dependences_known) {
    result += "too many active constraints to look for dependent ones\n";
  }
  for (std::size_t k = 0; k < std::min(dependent.size(), kShown); ++k) {
    result += concat(dependent[k].name,
                     dependent[k].others.empty() ? " is moved by no free variable" : " depends on");
    for (const std::string& other : dependent[k].others) {
      result += " " + other;
    }
    result += "\n";
  }
  for (const std::string& what : advice) {
    result += concat("try: ", what, "\n");
  }
  return result;
}

}  // namespace hbar::solvers
