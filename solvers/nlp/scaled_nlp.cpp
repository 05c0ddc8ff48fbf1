#include "hbar/solvers/nlp/scaled_nlp.h"

#include <algorithm>
#include <cmath>

namespace hbar::solvers {
namespace {

Eigen::VectorXd scale_or_ones(const Eigen::VectorXd& scale, Eigen::Index size) {
  return scale.size() > 0 ? scale : Eigen::VectorXd(Eigen::VectorXd::Ones(size));
}

/// values, zeros if there are none.
Eigen::VectorXd of_size(const char* what, const Eigen::VectorXd& values, Eigen::Index size) {
  if (values.size() == 0) {
    return Eigen::VectorXd::Zero(size);
  }
  if (values.size() != size) {
    throw InvalidInput(
        concat("point: ", what, " has ", values.size(), " entries; expected ", size));
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    if (std::isfinite(values[i])) {
      continue;
    }
    throw InvalidInput(
        concat("point: entry ", i, " of ", what, " is ", values[i], "; expected a finite number"));
  }
  return values;
}

}  // namespace

Eigen::VectorXd scale_from_bounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const Eigen::VectorXd& start) {
  if (lower.size() != start.size() || upper.size() != start.size()) {
    throw InvalidInput(concat("scale_from_bounds: ", lower.size(), " lower and ", upper.size(),
                              " upper bounds for ", start.size(), " variables"));
  }
  Eigen::VectorXd scale(start.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const double half_range = 0.5 * (upper[i] - lower[i]);
    const bool has_range = std::isfinite(half_range) && half_range > 0.0;
    scale[i] = has_range ? half_range : std::max(std::abs(start[i]), 1.0);
  }
  return scale;
}

ScaledNlp::ScaledNlp(Nlp& nlp, double tolerance, double objective_scale, HessianKind hessian)
    : variables_(nlp.variables()),
      limits_(nlp.constraint_limits()),
      jacobian_pattern_(nlp.jacobian_pattern()),
      kind_(hessian),
      evaluator_(nlp, tolerance),
      x_scale_(scale_or_ones(variables_.scale, variables_.start.size())),
      c_scale_(scale_or_ones(limits_.scale, limits_.lower.size())),
      f_scale_(objective_scale) {
  if (!(objective_scale > 0.0 && std::isfinite(objective_scale))) {
    throw InvalidInput(
        concat("the objective's scale is ", objective_scale, "; expected a positive number"));
  }
  if (kind_ != HessianKind::kLimitedMemory) {
    hessian_pattern_ = nlp.hessian_pattern(kind_);
  }
}

Eigen::VectorXd ScaledNlp::scaled_lower() const { return variables_.lower.cwiseQuotient(x_scale_); }

Eigen::VectorXd ScaledNlp::scaled_upper() const { return variables_.upper.cwiseQuotient(x_scale_); }

Eigen::VectorXd ScaledNlp::scaled_constraint_lower() const {
  return limits_.lower.cwiseQuotient(c_scale_);
}

Eigen::VectorXd ScaledNlp::scaled_constraint_upper() const {
  return limits_.upper.cwiseQuotient(c_scale_);
}

bool ScaledNlp::scaled_objective(const View& x, double& f) {
  const double* value = evaluator_.objective(x.cwiseProduct(x_scale_));
  if (value != nullptr) {
    f = *value / f_scale_;
  }
  return value != nullptr;
}

bool ScaledNlp::scaled_gradient(const View& x, Span g) {
  const Eigen::VectorXd* value = evaluator_.gradient(x.cwiseProduct(x_scale_));
  if (value != nullptr) {
    g = value->cwiseProduct(x_scale_) / f_scale_;
  }
  return value != nullptr;
}

bool ScaledNlp::scaled_constraints(const View& x, Span c) {
  const Eigen::VectorXd* value = evaluator_.constraints(x.cwiseProduct(x_scale_));
  if (value != nullptr) {
    c = value->cwiseQuotient(c_scale_);
  }
  return value != nullptr;
}

bool ScaledNlp::scaled_jacobian(const View& x, Span values) {
  const Eigen::VectorXd* value = evaluator_.jacobian(x.cwiseProduct(x_scale_));
  if (value == nullptr) {
    return false;
  }
  for (std::size_t k = 0; k < jacobian_pattern_.rows.size(); ++k) {
    const auto entry = static_cast<Eigen::Index>(k);
    values[entry] = (*value)[entry] * x_scale_[jacobian_pattern_.columns[k]] /
                    c_scale_[jacobian_pattern_.rows[k]];
  }
  return true;
}

bool ScaledNlp::scaled_hessian(const View& x, double sigma, const View& lambda, Span values) {
  const Eigen::VectorXd* value = evaluator_.hessian(x.cwiseProduct(x_scale_), sigma / f_scale_,
                                                    lambda.cwiseQuotient(c_scale_), kind_);
  if (value == nullptr) {
    return false;
  }
  for (std::size_t k = 0; k < hessian_pattern_.rows.size(); ++k) {
    const auto entry = static_cast<Eigen::Index>(k);
    values[entry] = (*value)[entry] * x_scale_[hessian_pattern_.rows[k]] *
                    x_scale_[hessian_pattern_.columns[k]];
  }
  return true;
}

PrimalDualPoint ScaledNlp::scaled(const PrimalDualPoint& point) const {
  const Eigen::Index n = variable_count();
  if (point.x.size() != n) {
    throw InvalidInput(concat("point: x has ", point.x.size(), " entries; expected ", n));
  }
  const auto bound = [&](const char* what, const Eigen::VectorXd& z) -> Eigen::VectorXd {
    return of_size(what, z, n).cwiseProduct(x_scale_) / f_scale_;
  };
  const Eigen::VectorXd x = of_size("x", point.x, n);
  return {x.cwiseMax(variables_.lower).cwiseMin(variables_.upper).cwiseQuotient(x_scale_),
          of_size("constraint_multipliers", point.constraint_multipliers, constraint_count())
                  .cwiseProduct(c_scale_) /
              f_scale_,
          bound("lower_multipliers", point.lower_multipliers),
          bound("upper_multipliers", point.upper_multipliers), point.mu};
}

PrimalDualPoint ScaledNlp::unscaled(PrimalDualPoint point) const {
  point.x = point.x.cwiseProduct(x_scale_).cwiseMax(variables_.lower).cwiseMin(variables_.upper);
  point.constraint_multipliers = point.constraint_multipliers.cwiseQuotient(c_scale_) * f_scale_;
  point.lower_multipliers = point.lower_multipliers.cwiseQuotient(x_scale_) * f_scale_;
  point.upper_multipliers = point.upper_multipliers.cwiseQuotient(x_scale_) * f_scale_;
  return point;
}

void ScaledNlp::throw_failure(const char* who) const {
  if (evaluator_.exception() != nullptr) {
    std::rethrow_exception(evaluator_.exception());
  }
  throw EvaluationError(
      concat(who, ": the point cannot be evaluated: ", evaluator_.last_failure()));
}

}  // namespace hbar::solvers
