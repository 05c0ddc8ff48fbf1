#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hbar/core/base/error.h"

namespace hbar::solvers {

/// Thrown by an Nlp where a point cannot be evaluated, for instance because a simulation failed
/// there. An optimiser then shortens its step instead of giving up.
class EvaluationError : public NumericalFailure {
 public:
  using NumericalFailure::NumericalFailure;
};

/// The variables x of a nonlinear program. A bound that does not exist is ± infinity; a variable
/// with lower = upper is held fixed.
struct NlpVariables {
  Eigen::VectorXd lower;           ///< lower bounds, unit of x                         [n]
  Eigen::VectorXd upper;           ///< upper bounds, unit of x                         [n]
  Eigen::VectorXd start;           ///< where to begin, within the bounds               [n]
  std::vector<std::string> names;  ///< for messages                                    [n]
  Eigen::VectorXd scale;           ///< typical size > 0 of a change of x; empty: ones  [n or 0]
};

/// The constraints lower ≤ c(x) ≤ upper of a nonlinear program; lower = upper is an equation.
struct NlpConstraints {
  Eigen::VectorXd lower;           ///< lower bounds, unit of c  [m]
  Eigen::VectorXd upper;           ///< upper bounds, unit of c  [m]
  std::vector<std::string> names;  ///< for messages             [m]
  Eigen::VectorXd scale;           ///< typical size > 0 of a change of c; empty: ones  [m or 0]
};

/// Where a matrix may be non-zero. Entries at the same place are summed.
struct SparsityPattern {
  std::vector<int> rows;     ///< row of each entry, from 0; in dc/dx the constraint   [entries]
  std::vector<int> columns;  ///< column of each entry, from 0; the variable           [entries]
};

/// How the Hessian of the Lagrangian L = σ f + λᵀ c is obtained.
enum class HessianKind {
  kExact,         ///< ∂²L/∂x²
  kGaussNewton,   ///< the same without the curvature of residuals and of c
  kLimitedMemory  ///< estimated by the optimiser from gradients; the program is not asked
};

/// A nonlinear program: minimise f(x) subject to lower ≤ x ≤ upper and lower ≤ c(x) ≤ upper.
///
/// The descriptions are constant while a program is being solved. Evaluations may be requested at
/// any x near the bounds and in any order; a program whose evaluations share work remembers the
/// last x. Each may throw EvaluationError; any other exception ends the optimisation.
class Nlp {
 public:
  Nlp() = default;
  Nlp(const Nlp&) = delete;
  Nlp& operator=(const Nlp&) = delete;
  virtual ~Nlp() = default;

  [[nodiscard]] virtual const NlpVariables& variables() const = 0;
  [[nodiscard]] virtual const NlpConstraints& constraint_limits() const = 0;
  [[nodiscard]] virtual const SparsityPattern& jacobian_pattern() const = 0;

  /// The objective f.
  ///
  /// @param x  variables  [n]
  [[nodiscard]] virtual double objective(const Eigen::VectorXd& x) = 0;

  /// The gradient df/dx.
  ///
  /// @param x  variables                      [n]
  /// @param g  output, sized by the caller    [n]
  virtual void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) = 0;

  /// The constraints c.
  ///
  /// @param x  variables                      [n]
  /// @param c  output, sized by the caller    [m]
  virtual void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) = 0;

  /// The entries of dc/dx in the order of jacobian_pattern().
  ///
  /// @param x       variables                    [n]
  /// @param values  output, sized by the caller  [entries]
  virtual void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) = 0;

  /// Where the Hessian of L = σ f + λᵀ c may be non-zero: places in its lower triangle
  /// (row ≥ column) only.
  ///
  /// @param kind  kExact or kGaussNewton
  /// @throws InvalidInput if the program has no second derivatives of that kind, saying why (as
  ///   this default does)
  [[nodiscard]] virtual const SparsityPattern& hessian_pattern(HessianKind kind);

  /// The entries of that Hessian in the order of hessian_pattern(kind).
  ///
  /// @param x       variables                     [n]
  /// @param sigma   factor of the objective
  /// @param lambda  multipliers of c              [m]
  /// @param kind    kExact or kGaussNewton
  /// @param values  output, sized by the caller   [entries]
  virtual void lagrangian_hessian(const Eigen::VectorXd& x, double sigma,
                                  const Eigen::VectorXd& lambda, HessianKind kind,
                                  Eigen::VectorXd& values);
};

/// Refuses a program that does not describe itself consistently.
///
/// @throws InvalidInput naming the variable or constraint, if sizes disagree, there is no free
///   variable, a bound or a start is not a number, lower exceeds upper, the start lies outside its
///   bounds, a scale is not positive, or the Jacobian pattern points outside the matrix
void validate(const Nlp& nlp);

/// Refuses a program whose Hessian has no consistent pattern; accepts any program for
/// kLimitedMemory.
///
/// @param nlp   validated
/// @param kind  which Hessian is to be used
/// @throws InvalidInput if the program has no Hessian of that kind, or its pattern points outside
///   the lower triangle of an n x n matrix
void validate_hessian(Nlp& nlp, HessianKind kind);

/// A violated constraint or bound.
struct Violation {
  double amount = 0.0;    ///< by how much, 0 if nothing is violated; unit of its constraint
  std::string name;       ///< of the worst constraint or variable; empty if amount is 0
  double relative = 0.0;  ///< amount over the typical size (scale) of its constraint
};

/// The largest violation of constraints and bounds, in units of their typical sizes.
///
/// @param nlp  the program
/// @param x    variables               [n]
/// @param c    constraints(x)          [m]
[[nodiscard]] Violation largest_violation(const Nlp& nlp, const Eigen::VectorXd& x,
                                          const Eigen::VectorXd& c);

}  // namespace hbar::solvers
