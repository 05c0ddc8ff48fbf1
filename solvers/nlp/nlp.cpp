#include "hbar/solvers/nlp/nlp.h"

#include <algorithm>
#include <cmath>

namespace hbar::solvers {
namespace {

void refuse_size(const char* what, Eigen::Index got, Eigen::Index expected) {
  if (got == expected) {
    return;
  }
  throw InvalidInput(concat("nlp: ", what, " has ", got, " entries; expected ", expected));
}

std::string item(const char* kind, Eigen::Index i, const std::vector<std::string>& names) {
  return concat("nlp: ", kind, " ", i, " (", names[static_cast<std::size_t>(i)], ")");
}

void refuse_limits(const char* kind, Eigen::Index i, const std::vector<std::string>& names,
                   double lower, double upper) {
  if (std::isnan(lower) || std::isnan(upper)) {
    throw InvalidInput(concat(item(kind, i, names), ": the bounds are ", lower, " and ", upper,
                              "; expected numbers, infinite where there is no bound"));
  }
  if (lower > upper) {
    throw InvalidInput(concat(item(kind, i, names), ": the lower bound ", lower,
                              " exceeds the upper bound ", upper));
  }
}

void refuse_scale(const char* kind, const Eigen::VectorXd& scale,
                  const std::vector<std::string>& names) {
  if (scale.size() == 0) {
    return;
  }
  refuse_size(concat("scale of the ", kind, "s").c_str(), scale.size(),
              static_cast<Eigen::Index>(names.size()));
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    if (scale[i] > 0.0 && std::isfinite(scale[i])) {
      continue;
    }
    throw InvalidInput(
        concat(item(kind, i, names), ": the scale is ", scale[i], "; expected a positive number"));
  }
}

void refuse_pattern(const char* matrix, const SparsityPattern& pattern, Eigen::Index rows,
                    Eigen::Index columns) {
  refuse_size(concat("columns of the ", matrix, " pattern").c_str(),
              static_cast<Eigen::Index>(pattern.columns.size()),
              static_cast<Eigen::Index>(pattern.rows.size()));
  for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
    const int row = pattern.rows[k];
    const int column = pattern.columns[k];
    if (row >= 0 && row < rows && column >= 0 && column < columns) {
      continue;
    }
    throw InvalidInput(concat("nlp: entry ", k, " of the ", matrix, " pattern is at row ", row,
                              ", column ", column, "; the ", matrix, " is ", rows, " x ", columns));
  }
}

void validate_variables(const NlpVariables& v) {
  const Eigen::Index n = v.start.size();
  if (n == 0) {
    throw InvalidInput("nlp: there are no variables; expected at least one");
  }
  refuse_size("lower bounds of the variables", v.lower.size(), n);
  refuse_size("upper bounds of the variables", v.upper.size(), n);
  refuse_size("names of the variables", static_cast<Eigen::Index>(v.names.size()), n);
  refuse_scale("variable", v.scale, v.names);
  bool any_free = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    refuse_limits("variable", i, v.names, v.lower[i], v.upper[i]);
    if (!std::isfinite(v.start[i])) {
      throw InvalidInput(concat(item("variable", i, v.names), ": the start is ", v.start[i],
                                "; expected a finite number"));
    }
    if (v.start[i] < v.lower[i] || v.start[i] > v.upper[i]) {
      throw InvalidInput(concat(item("variable", i, v.names), ": the start ", v.start[i],
                                " is outside its bounds ", v.lower[i], " to ", v.upper[i]));
    }
    any_free = any_free || v.lower[i] < v.upper[i];
  }
  if (!any_free) {
    throw InvalidInput(concat("nlp: no free variable: all ", n,
                              " have equal lower and upper bounds; widen at least one"));
  }
}

}  // namespace

const SparsityPattern& Nlp::hessian_pattern(HessianKind) {
  throw InvalidInput("nlp: this program has no second derivatives; use the limited-memory Hessian");
}

void Nlp::lagrangian_hessian(const Eigen::VectorXd&, double, const Eigen::VectorXd&,
                             HessianKind kind, Eigen::VectorXd&) {
  static_cast<void>(hessian_pattern(kind));  // says so
}

void validate(const Nlp& nlp) {
  const NlpVariables& v = nlp.variables();
  validate_variables(v);
  const NlpConstraints& c = nlp.constraint_limits();
  const Eigen::Index n = v.start.size();
  const Eigen::Index m = c.lower.size();
  refuse_size("upper bounds of the constraints", c.upper.size(), m);
  refuse_size("names of the constraints", static_cast<Eigen::Index>(c.names.size()), m);
  for (Eigen::Index i = 0; i < m; ++i) {
    refuse_limits("constraint", i, c.names, c.lower[i], c.upper[i]);
  }
  refuse_scale("constraint", c.scale, c.names);
  refuse_pattern("Jacobian", nlp.jacobian_pattern(), m, n);
}

void validate_hessian(Nlp& nlp, HessianKind kind) {
  if (kind == HessianKind::kLimitedMemory) {
    return;
  }
  const SparsityPattern& pattern = nlp.hessian_pattern(kind);
  const Eigen::Index n = nlp.variables().start.size();
  refuse_pattern("Hessian", pattern, n, n);
  for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
    if (pattern.rows[k] >= pattern.columns[k]) {
      continue;
    }
    throw InvalidInput(concat("nlp: entry ", k, " of the Hessian pattern is at row ",
                              pattern.rows[k], ", column ", pattern.columns[k],
                              "; expected the lower triangle, row >= column"));
  }
}

Violation largest_violation(const Nlp& nlp, const Eigen::VectorXd& x, const Eigen::VectorXd& c) {
  Violation worst;
  const auto add = [&worst](Eigen::Index i, double value, const auto& limits) {
    const double amount = std::max(limits.lower[i] - value, value - limits.upper[i]);
    const double relative = limits.scale.size() > 0 ? amount / limits.scale[i] : amount;
    if (relative > worst.relative) {
      worst = {amount, limits.names[static_cast<std::size_t>(i)], relative};
    }
  };
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    add(i, c[i], nlp.constraint_limits());
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    add(i, x[i], nlp.variables());
  }
  return worst;
}

}  // namespace hbar::solvers
