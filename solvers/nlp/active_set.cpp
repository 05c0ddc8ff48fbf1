#include "hbar/solvers/nlp/active_set.h"

#include <Eigen/QR>
#include <cmath>

namespace hbar::solvers {
namespace {

constexpr Eigen::Index kMostDenseEntries = 1'000'000;
// Gradients whose independent part is shorter than this fraction count as dependent.
constexpr double kDependent = 1e-9;
// Coefficients of a combination that are smaller than this fraction are rounding.
constexpr double kCoefficient = 1e-6;

std::vector<Activity> activities(const Eigen::VectorXd& value, const Eigen::VectorXd& lower,
                                 const Eigen::VectorXd& upper, double tolerance) {
  std::vector<Activity> result;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    Activity activity = Activity::kInactive;
    if (lower[i] == upper[i]) {
      activity = Activity::kEqual;
    } else {
      // Where a range is narrower than the tolerance the nearer bound counts.
      const bool low = value[i] - lower[i] <= upper[i] - value[i];
      const double distance = low ? value[i] - lower[i] : upper[i] - value[i];
      if (distance <= tolerance) {
        activity = low ? Activity::kLower : Activity::kUpper;
      }
    }
    result.push_back(activity);
  }
  return result;
}

/// Rows of the active constraints with respect to the free variables, transposed.
struct ActiveJacobian {
  std::vector<int> constraints;  // of each column of `transposed`
  std::vector<int> variables;    // of each row
  Eigen::MatrixXd transposed;
};

std::vector<int> places(const std::vector<Activity>& activity, bool active) {
  std::vector<int> result;
  for (std::size_t i = 0; i < activity.size(); ++i) {
    if ((activity[i] != Activity::kInactive) == active) {
      result.push_back(static_cast<int>(i));
    }
  }
  return result;
}

void fill(const SparsityPattern& pattern, const Eigen::VectorXd& values, ActiveJacobian& A,
          Eigen::Index n, Eigen::Index m) {
  A.transposed.setZero(static_cast<Eigen::Index>(A.variables.size()),
                       static_cast<Eigen::Index>(A.constraints.size()));
  Eigen::VectorXi row_of = Eigen::VectorXi::Constant(n, -1);
  Eigen::VectorXi column_of = Eigen::VectorXi::Constant(m, -1);
  for (std::size_t k = 0; k < A.variables.size(); ++k) {
    row_of[A.variables[k]] = static_cast<int>(k);
  }
  for (std::size_t k = 0; k < A.constraints.size(); ++k) {
    column_of[A.constraints[k]] = static_cast<int>(k);
  }
  for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
    const int column = column_of[pattern.rows[k]];
    const int row = row_of[pattern.columns[k]];
    if (column >= 0 && row >= 0) {
      A.transposed(row, column) += values[static_cast<Eigen::Index>(k)];
    }
  }
}

using Decomposition = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

std::vector<Dependence> find_dependences(const Decomposition& qr, const std::vector<int>& of) {
  std::vector<Dependence> result;
  const Eigen::Index rank = qr.rank();
  const auto& order = qr.colsPermutation().indices();
  for (Eigen::Index k = rank; k < qr.cols(); ++k) {
    Dependence dependence{of[static_cast<std::size_t>(order[k])], {}};
    Eigen::VectorXd weights = qr.matrixR().col(k).head(rank);
    qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(weights);
    for (Eigen::Index i = 0; i < rank; ++i) {
      if (std::abs(weights[i]) <= kCoefficient * weights.lpNorm<Eigen::Infinity>()) {
        continue;
      }
      dependence.others.push_back(of[static_cast<std::size_t>(order[i])]);
    }
    result.push_back(std::move(dependence));
  }
  return result;
}

bool right_sign(Activity activity, double multiplier) {
  return activity == Activity::kEqual || (activity == Activity::kLower) == (multiplier < 0.0);
}

void require_sizes(const ScaledNlp& program, const Eigen::VectorXd& x, const Eigen::VectorXd& c,
                   const char* where) {
  if (x.size() != program.variable_count() || c.size() != program.constraint_count()) {
    throw InvalidInput(concat(where, ": ", x.size(), " variables and ", c.size(),
                              " constraints or multipliers; the program has ",
                              program.variable_count(), " and ", program.constraint_count()));
  }
}

}  // namespace

ActiveSet find_active_set(const ScaledNlp& program, const Eigen::VectorXd& x,
                          const Eigen::VectorXd& c, double tolerance) {
  require_sizes(program, x, c, "find_active_set");
  return {activities(x, program.scaled_lower(), program.scaled_upper(), tolerance),
          activities(c, program.scaled_constraint_lower(), program.scaled_constraint_upper(),
                     tolerance)};
}

Eigen::VectorXd lagrangian_gradient(ScaledNlp& program, const PrimalDualPoint& point) {
  require_sizes(program, point.x, point.constraint_multipliers, "lagrangian_gradient");
  const SparsityPattern& pattern = program.jacobian_pattern();
  Eigen::VectorXd gradient(program.variable_count());
  Eigen::VectorXd jacobian(static_cast<Eigen::Index>(pattern.rows.size()));
  if (!program.scaled_gradient(point.x, gradient) ||
      (program.constraint_count() > 0 && !program.scaled_jacobian(point.x, jacobian))) {
    program.throw_failure("multipliers");
  }
  for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
    gradient[pattern.columns[k]] +=
        jacobian[static_cast<Eigen::Index>(k)] * point.constraint_multipliers[pattern.rows[k]];
  }
  return gradient - point.lower_multipliers + point.upper_multipliers;
}

MultiplierEstimate estimate_multipliers(ScaledNlp& program, const Eigen::VectorXd& x,
                                        double tolerance) {
  const Eigen::Index n = program.variable_count();
  const Eigen::Index m = program.constraint_count();
  require_sizes(program, x, Eigen::VectorXd::Zero(m), "estimate_multipliers");
  MultiplierEstimate result;
  result.point = {x, Eigen::VectorXd::Zero(m), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd c(m);
  if (!program.scaled_constraints(x, c)) {
    program.throw_failure("multipliers");
  }
  result.active = find_active_set(program, x, c, tolerance);
  ActiveJacobian A{
      places(result.active.constraints, true), places(result.active.variables, false), {}};
  Eigen::VectorXd gradient = lagrangian_gradient(program, result.point);
  const auto entries = static_cast<Eigen::Index>(A.constraints.size() * A.variables.size());
  result.examined = entries <= kMostDenseEntries;
  if (result.examined && entries > 0) {
    const SparsityPattern& pattern = program.jacobian_pattern();
    Eigen::VectorXd jacobian(static_cast<Eigen::Index>(pattern.rows.size()));
    if (!program.scaled_jacobian(x, jacobian)) {
      program.throw_failure("multipliers");
    }
    fill(pattern, jacobian, A, n, m);
    Decomposition qr;
    qr.setThreshold(kDependent);
    qr.compute(A.transposed);
    result.dependences = find_dependences(qr, A.constraints);
    const Eigen::VectorXd multipliers = qr.solve(-gradient(A.variables));
    for (std::size_t k = 0; k < A.constraints.size(); ++k) {
      const double multiplier = multipliers[static_cast<Eigen::Index>(k)];
      const auto constraint = static_cast<std::size_t>(A.constraints[k]);
      if (!right_sign(result.active.constraints[constraint], multiplier)) {
        continue;
      }
      result.point.constraint_multipliers[A.constraints[k]] = multiplier;
    }
    gradient = lagrangian_gradient(program, result.point);
  }
  for (const int i : places(result.active.variables, true)) {
    const Activity activity = result.active.variables[static_cast<std::size_t>(i)];
    if (activity != Activity::kUpper) {
      result.point.lower_multipliers[i] = std::max(gradient[i], 0.0);
    }
    if (activity != Activity::kLower) {
      result.point.upper_multipliers[i] = std::max(-gradient[i], 0.0);
    }
  }
  result.stationarity = lagrangian_gradient(program, result.point).lpNorm<Eigen::Infinity>();
  return result;
}

}  // namespace hbar::solvers
