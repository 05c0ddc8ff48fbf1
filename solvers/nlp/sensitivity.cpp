#include "hbar/solvers/nlp/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "hbar/solvers/linear/cached_solver.h"
#include "hbar/solvers/linear/row_scaling.h"

namespace hbar::solvers {
namespace {

/// The KKT system of an optimum with its active set held; scaled throughout.
class HeldOptimum {
 public:
  HeldOptimum(Nlp& nlp, const PrimalDualPoint& optimum, const std::vector<int>& theta,
              const SensitivityOptions& options)
      : nlp_(nlp),
        options_(options),
        theta_(theta),
        program_(nlp, options.tolerance, options.objective_scale, HessianKind::kExact),
        point_(program_.scaled(optimum)) {
    refuse_theta();
    hold();
    refuse_other_points();
    number_unknowns();
  }

  [[nodiscard]] Sensitivity solve();

 private:
  void refuse_theta() const;
  void hold();
  void refuse_other_points();
  void number_unknowns();
  void assemble();
  void equilibrate();
  [[nodiscard]] std::string name_of_unknown(int unknown) const;
  [[nodiscard]] const std::string& variable_name(Eigen::Index i) const {
    return nlp_.variables().names[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Eigen::Index parameter_count() const {
    return static_cast<Eigen::Index>(theta_.size());
  }

  Nlp& nlp_;
  const SensitivityOptions& options_;
  const std::vector<int>& theta_;
  ScaledNlp program_;
  PrimalDualPoint point_;
  ActiveSet held_;
  std::vector<std::string> weak_;
  Eigen::VectorXi unknown_of_variable_;    // -1: held  [n]
  Eigen::VectorXi unknown_of_constraint_;  // -1: not held  [m]
  Eigen::VectorXi column_of_;              // of theta, -1: none  [n]
  int unknowns_ = 0;
  SparseMatrix K_;
  Eigen::MatrixXd right_;  // [unknowns x p]
  Eigen::VectorXd balance_;
};

void HeldOptimum::refuse_theta() const {
  const NlpVariables& v = nlp_.variables();
  std::vector<bool> seen(v.names.size(), false);
  for (const int index : theta_) {
    if (index < 0 || index >= v.start.size()) {
      throw InvalidInput(concat("sensitivity: theta names variable ", index, "; there are ",
                                v.start.size(), ", counted from 0"));
    }
    if (v.lower[index] != v.upper[index]) {
      throw InvalidInput(concat("sensitivity: variable ", index, " (", variable_name(index),
                                ") is not fixed; expected lower = upper for every entry of theta"));
    }
    if (seen[static_cast<std::size_t>(index)]) {
      throw InvalidInput(concat("sensitivity: theta names variable ", index, " (",
                                variable_name(index), ") twice"));
    }
    seen[static_cast<std::size_t>(index)] = true;
  }
}

/// Finds what is held; multipliers of everything else become zero.
void HeldOptimum::hold() {
  Eigen::VectorXd c(program_.constraint_count());
  if (!program_.scaled_constraints(point_.x, c)) {
    program_.throw_failure("sensitivity");
  }
  held_ = find_active_set(program_, point_.x, c, options_.tolerance);
  const auto release = [&](Activity& activity, double multiplier, const std::string& name) {
    if (activity == Activity::kInactive || activity == Activity::kEqual) {
      return;
    }
    if (multiplier > options_.tolerance) {
      return;
    }
    weak_.push_back(name);
    activity = Activity::kInactive;
  };
  for (Eigen::Index i = 0; i < point_.x.size(); ++i) {
    Activity& activity = held_.variables[static_cast<std::size_t>(i)];
    const bool upper = activity == Activity::kUpper;
    release(activity, upper ? point_.upper_multipliers[i] : point_.lower_multipliers[i],
            variable_name(i));
  }
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    Activity& activity = held_.constraints[static_cast<std::size_t>(i)];
    double& multiplier = point_.constraint_multipliers[i];
    release(activity, activity == Activity::kUpper ? multiplier : -multiplier,
            nlp_.constraint_limits().names[static_cast<std::size_t>(i)]);
    if (activity == Activity::kInactive) {
      multiplier = 0.0;
    }
  }
  const Eigen::VectorXd& c_scale = nlp_.constraint_limits().scale;
  if (c_scale.size() > 0) {
    c = c.cwiseProduct(c_scale);
  }
  const Violation violation = largest_violation(nlp_, program_.unscaled(point_).x, c);
  if (violation.relative > options_.tolerance) {
    throw NumericalFailure(concat("sensitivity: the point is no optimum: ", violation.name,
                                  " is violated by ", violation.amount));
  }
}

void HeldOptimum::refuse_other_points() {
  point_.lower_multipliers.setZero();
  point_.upper_multipliers.setZero();
  const Eigen::VectorXd gradient = lagrangian_gradient(program_, point_);
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (held_.variables[static_cast<std::size_t>(i)] != Activity::kInactive) {
      continue;
    }
    if (std::abs(gradient[i]) <= options_.tolerance) {
      continue;
    }
    throw NumericalFailure(
        concat("sensitivity: the point is no optimum: the Lagrangian's gradient ", "by ",
               variable_name(i), " is ", gradient[i],
               " in units of the scales; optimise further, or give its "
               "multipliers"));
  }
}

void HeldOptimum::number_unknowns() {
  const auto number = [this](const std::vector<Activity>& activities, bool held) {
    Eigen::VectorXi unknown =
        Eigen::VectorXi::Constant(static_cast<Eigen::Index>(activities.size()), -1);
    for (std::size_t i = 0; i < activities.size(); ++i) {
      if ((activities[i] != Activity::kInactive) != held) {
        continue;
      }
      unknown[static_cast<Eigen::Index>(i)] = unknowns_++;
    }
    return unknown;
  };
  unknown_of_variable_ = number(held_.variables, false);
  unknown_of_constraint_ = number(held_.constraints, true);
  column_of_ = Eigen::VectorXi::Constant(point_.x.size(), -1);
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    column_of_[theta_[k]] = static_cast<int>(k);
  }
}

void HeldOptimum::assemble() {
  std::vector<Eigen::Triplet<double>> entries;
  right_.setZero(unknowns_, parameter_count());
  const auto add = [&](int row, int variable, double value) {
    if (row < 0) {
      return;
    }
    const int column = unknown_of_variable_[variable];
    if (column >= 0) {
      entries.emplace_back(row, column, value);
    }
    if (column_of_[variable] >= 0) {
      right_(row, column_of_[variable]) -= value;
    }
  };
  const SparsityPattern& H = program_.hessian_pattern();
  Eigen::VectorXd values(static_cast<Eigen::Index>(H.rows.size()));
  if (!program_.scaled_hessian(point_.x, 1.0, point_.constraint_multipliers, values)) {
    program_.throw_failure("sensitivity");
  }
  for (std::size_t k = 0; k < H.rows.size(); ++k) {
    const double value = values[static_cast<Eigen::Index>(k)];
    add(unknown_of_variable_[H.rows[k]], H.columns[k], value);
    if (H.rows[k] != H.columns[k]) {
      add(unknown_of_variable_[H.columns[k]], H.rows[k], value);
    }
  }
  const SparsityPattern& A = program_.jacobian_pattern();
  values.resize(static_cast<Eigen::Index>(A.rows.size()));
  if (values.size() > 0 && !program_.scaled_jacobian(point_.x, values)) {
    program_.throw_failure("sensitivity");
  }
  for (std::size_t k = 0; k < A.rows.size(); ++k) {
    const int row = unknown_of_constraint_[A.rows[k]];
    const int column = unknown_of_variable_[A.columns[k]];
    const double value = values[static_cast<Eigen::Index>(k)];
    add(row, A.columns[k], value);
    if (row >= 0 && column >= 0) {
      entries.emplace_back(column, row, value);
    }
  }
  K_.resize(unknowns_, unknowns_);
  K_.setFromTriplets(entries.begin(), entries.end());
  K_.makeCompressed();
}

/// Brings the largest entry of every row and column near 1, keeping symmetry (D. Ruiz, A scaling
/// algorithm to equilibrate both rows and columns norms in matrices, 2001).
void HeldOptimum::equilibrate() {
  constexpr int kSweeps = 4;
  balance_.setOnes(unknowns_);
  Eigen::VectorXd largest(unknowns_);
  Eigen::VectorXd factor(unknowns_);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int j = 0; j < unknowns_; ++j) {
      largest[j] = 0.0;
      for (SparseMatrix::InnerIterator it(K_, j); it; ++it) {
        largest[j] = std::max(largest[j], std::abs(it.value()));
      }
    }
    set_power_of_two_scales(largest.cwiseSqrt(), factor);
    K_ = factor.asDiagonal() * K_ * factor.asDiagonal();
    balance_ = balance_.cwiseProduct(factor);
  }
}

std::string HeldOptimum::name_of_unknown(int unknown) const {
  const auto find = [unknown](const Eigen::VectorXi& numbers, const std::vector<std::string>& names,
                              const char* kind) -> std::string {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      if (numbers[i] == unknown) {
        return concat(kind, names[static_cast<std::size_t>(i)]);
      }
    }
    return "";
  };
  const std::string variable = find(unknown_of_variable_, nlp_.variables().names, "variable ");
  if (!variable.empty()) {
    return variable;
  }
  return find(unknown_of_constraint_, nlp_.constraint_limits().names, "constraint ");
}

Sensitivity HeldOptimum::solve() {
  assemble();
  equilibrate();
  right_ = balance_.asDiagonal() * right_;
  if (unknowns_ > 0) {
    const SolverFactory factory = options_.solver ? options_.solver : default_solver();
    const std::unique_ptr<LinearSolver> solver = factory({}, K_);
    solver->name_unknowns([this](int unknown) { return name_of_unknown(unknown); });
    try {
      solver->analyze(K_);
      solver->factorize(K_);
      solver->solve(right_, right_);
    } catch (const NumericalFailure& failure) {
      throw NumericalFailure(concat("sensitivity: the KKT matrix is singular (", failure.what(),
                                    "): the held constraints depend on each other, or leave a ",
                                    "direction in which the Lagrangian is flat"));
    }
  }
  right_ = balance_.asDiagonal() * right_;

  const Eigen::Index p = parameter_count();
  const Eigen::VectorXd gradient = lagrangian_gradient(program_, point_);
  Sensitivity result;
  result.dx_dtheta.setZero(point_.x.size(), p);
  result.dlambda_dtheta.setZero(point_.constraint_multipliers.size(), p);
  result.df_dtheta.resize(p);
  // A unit of theta is 1 / scale of its scaled value.
  const NlpVariables& v = nlp_.variables();
  const NlpConstraints& limits = nlp_.constraint_limits();
  const auto size = [](const Eigen::VectorXd& scale, Eigen::Index i) {
    return scale.size() > 0 ? scale[i] : 1.0;
  };
  for (Eigen::Index j = 0; j < p; ++j) {
    const int parameter = theta_[static_cast<std::size_t>(j)];
    const double unit = size(v.scale, parameter);
    for (Eigen::Index i = 0; i < point_.x.size(); ++i) {
      const int unknown = unknown_of_variable_[i];
      if (unknown >= 0) {
        result.dx_dtheta(i, j) = right_(unknown, j) * size(v.scale, i) / unit;
      }
    }
    result.dx_dtheta(parameter, j) = 1.0;
    for (Eigen::Index i = 0; i < result.dlambda_dtheta.rows(); ++i) {
      const int unknown = unknown_of_constraint_[i];
      if (unknown < 0) {
        continue;
      }
      result.dlambda_dtheta(i, j) =
          right_(unknown, j) * options_.objective_scale / (size(limits.scale, i) * unit);
    }
    result.df_dtheta[j] = gradient[parameter] * options_.objective_scale / unit;
  }
  result.held = held_;
  result.weakly_active = weak_;
  return result;
}

}  // namespace

Sensitivity sensitivity_of_optimum(Nlp& nlp, const PrimalDualPoint& optimum,
                                   const std::vector<int>& theta,
                                   const SensitivityOptions& options) {
  validate(nlp);
  validate_hessian(nlp, HessianKind::kExact);
  if (!(options.tolerance > 0.0)) {
    throw InvalidInput(concat("sensitivity: the tolerance is ", options.tolerance,
                              "; expected a positive number"));
  }
  return HeldOptimum(nlp, optimum, theta, options).solve();
}

}  // namespace hbar::solvers
