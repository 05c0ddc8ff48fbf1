#pragma once

#include <Eigen/Core>
#include <exception>
#include <functional>

#include "hbar/solvers/nlp/nlp.h"
#include "hbar/solvers/nlp/nlp_evaluator.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::solvers {

/// Typical sizes for variables without a given scale: half the range if both bounds are finite and
/// differ; else max(|start|, 1).
///
/// @param lower  lower bounds; ± infinity if there is none     [n]
/// @param upper  upper bounds                                  [n]
/// @param start  where to begin                                [n]
/// @returns sizes > 0                                          [n]
/// @throws InvalidInput if the sizes differ
[[nodiscard]] Eigen::VectorXd scale_from_bounds(const Eigen::VectorXd& lower,
                                                const Eigen::VectorXd& upper,
                                                const Eigen::VectorXd& start);

/// A program as an optimiser sees it: variables, constraints and objective divided by their typical
/// sizes, failures reported as `false`. Functions named `scaled` take and return these units;
/// everything else is in the program's. Independent of any optimiser.
class ScaledNlp {
 public:
  using Span = Eigen::Ref<Eigen::VectorXd>;
  using View = Eigen::Ref<const Eigen::VectorXd>;

  /// @param nlp              validated, also for `hessian`; must outlive this object
  /// @param tolerance        largest violation of a feasible point, in units of the typical sizes
  /// @param objective_scale  typical size > 0 of the objective
  /// @param hessian          which Hessian will be requested
  /// @throws InvalidInput if objective_scale is not positive
  ScaledNlp(Nlp& nlp, double tolerance, double objective_scale,
            HessianKind hessian = HessianKind::kLimitedMemory);

  [[nodiscard]] Eigen::Index variable_count() const { return x_scale_.size(); }
  [[nodiscard]] Eigen::Index constraint_count() const { return c_scale_.size(); }
  [[nodiscard]] const SparsityPattern& jacobian_pattern() const { return jacobian_pattern_; }
  /// Empty for kLimitedMemory.
  [[nodiscard]] const SparsityPattern& hessian_pattern() const { return hessian_pattern_; }
  [[nodiscard]] double objective_scale() const { return f_scale_; }

  [[nodiscard]] Eigen::VectorXd scaled_lower() const;             ///< of x; may be infinite  [n]
  [[nodiscard]] Eigen::VectorXd scaled_upper() const;             ///< of x                   [n]
  [[nodiscard]] Eigen::VectorXd scaled_constraint_lower() const;  ///< of c                   [m]
  [[nodiscard]] Eigen::VectorXd scaled_constraint_upper() const;  ///< of c                   [m]

  /// Values at a scaled x, written to the last argument; false where x cannot be evaluated.
  ///
  /// @param x  scaled variables  [n]
  /// @param f  scaled objective
  [[nodiscard]] bool scaled_objective(const View& x, double& f);
  /// @param g  scaled gradient  [n]
  [[nodiscard]] bool scaled_gradient(const View& x, Span g);
  /// @param c  scaled constraints  [m]
  [[nodiscard]] bool scaled_constraints(const View& x, Span c);
  /// @param values  scaled entries of jacobian_pattern()  [entries]
  [[nodiscard]] bool scaled_jacobian(const View& x, Span values);
  /// @param sigma   factor of the scaled objective
  /// @param lambda  multipliers of the scaled constraints  [m]
  /// @param values  scaled entries of hessian_pattern()    [entries]
  [[nodiscard]] bool scaled_hessian(const View& x, double sigma, const View& lambda, Span values);

  /// A point in the optimiser's units.
  ///
  /// @param point  in the program's units; x is moved into its bounds, empty multipliers stand for
  ///               zeros
  /// @throws InvalidInput if a size differs, or a number is not finite
  [[nodiscard]] PrimalDualPoint scaled(const PrimalDualPoint& point) const;
  /// A point in the program's units, x within its bounds.
  [[nodiscard]] PrimalDualPoint unscaled(PrimalDualPoint point) const;

  /// Throws the error that made the last evaluation fail.
  ///
  /// @param who  beginning of the message, such as "sensitivity"
  /// @throws EvaluationError, or whatever else the program threw
  [[noreturn]] void throw_failure(const char* who) const;

  /// Evaluations in the program's units, their counts, failures and the best point.
  [[nodiscard]] NlpEvaluator& evaluator() { return evaluator_; }
  [[nodiscard]] const NlpEvaluator& evaluator() const { return evaluator_; }

 private:
  const NlpVariables variables_;
  const NlpConstraints limits_;
  const SparsityPattern jacobian_pattern_;
  SparsityPattern hessian_pattern_;
  HessianKind kind_;
  NlpEvaluator evaluator_;
  Eigen::VectorXd x_scale_;
  Eigen::VectorXd c_scale_;
  double f_scale_;
};

}  // namespace hbar::solvers
