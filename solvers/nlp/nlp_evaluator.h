#pragma once

#include <Eigen/Core>
#include <exception>
#include <string>

#include "hbar/solvers/nlp/nlp.h"

namespace hbar::solvers {

/// How often an Nlp's functions were called.
struct EvaluationCounts {
  int objective = 0;
  int gradient = 0;
  int constraints = 0;
  int jacobian = 0;
  int hessian = 0;
  int failures = 0;  ///< calls that threw EvaluationError or gave a number that is not finite
};

/// The best point seen: the feasible one with the lowest objective or, if none is feasible, the
/// least infeasible one.
struct BestPoint {
  bool found = false;      ///< whether any point was evaluated completely
  bool feasible = false;   ///< violation within the tolerance
  Eigen::VectorXd x;       ///< variables    [n]
  Eigen::VectorXd c;       ///< constraints  [m]
  double objective = 0.0;  ///< f(x)
  double violation = 0.0;  ///< of the worst constraint or bound, in units of its typical size
};

/// Evaluates an Nlp for an optimiser: each function at most once per x and only on request; failed
/// evaluations give `nullptr`; any other exception is kept for later; the best point is remembered.
/// Independent of any optimiser.
class NlpEvaluator {
 public:
  /// @param nlp        validated; must outlive this object
  /// @param tolerance  largest violation of a feasible point, in units of the typical sizes
  NlpEvaluator(Nlp& nlp, double tolerance);

  /// The value at x, or nullptr if x cannot be evaluated. The pointer is valid until the next call
  /// with another x.
  ///
  /// @param x  variables  [n]
  [[nodiscard]] const double* objective(const Eigen::VectorXd& x);
  [[nodiscard]] const Eigen::VectorXd* gradient(const Eigen::VectorXd& x);
  [[nodiscard]] const Eigen::VectorXd* constraints(const Eigen::VectorXd& x);
  [[nodiscard]] const Eigen::VectorXd* jacobian(const Eigen::VectorXd& x);

  /// The entries of the Hessian of σ f + λᵀ c, evaluated at most once per (x, σ, λ, kind).
  ///
  /// @param x       variables                [n]
  /// @param sigma   factor of the objective
  /// @param lambda  multipliers              [m]
  /// @param kind    kExact or kGaussNewton
  [[nodiscard]] const Eigen::VectorXd* hessian(const Eigen::VectorXd& x, double sigma,
                                               const Eigen::VectorXd& lambda, HessianKind kind);

  [[nodiscard]] const EvaluationCounts& counts() const { return counts_; }
  [[nodiscard]] const BestPoint& best() const { return best_; }
  /// What the last failed evaluation said; empty if none failed.
  [[nodiscard]] const std::string& last_failure() const { return last_failure_; }

  /// The exception, other than EvaluationError, that an evaluation threw. From then on every
  /// evaluation fails without calling the program.
  [[nodiscard]] const std::exception_ptr& exception() const { return exception_; }

 private:
  enum class State { kUnknown, kKnown, kFailed };

  void move_to(const Eigen::VectorXd& x);
  template <typename Call>
  [[nodiscard]] bool evaluate(State& state, int& count, const Call& call);
  [[nodiscard]] bool finite_or_fail(const Eigen::VectorXd& values, Eigen::Index size,
                                    const char* what);
  void remember_if_best();

  Nlp& nlp_;
  double tolerance_;
  Eigen::VectorXd x_;
  double f_ = 0.0;
  Eigen::VectorXd g_;
  Eigen::VectorXd c_;
  Eigen::VectorXd jacobian_;
  Eigen::VectorXd hessian_;
  double sigma_ = 0.0;  // of hessian_, as are the next two
  Eigen::VectorXd lambda_;
  HessianKind kind_ = HessianKind::kExact;
  State f_state_ = State::kUnknown;
  State g_state_ = State::kUnknown;
  State c_state_ = State::kUnknown;
  State jacobian_state_ = State::kUnknown;
  State hessian_state_ = State::kUnknown;
  EvaluationCounts counts_;
  BestPoint best_;
  std::string last_failure_;
  std::exception_ptr exception_;
};

}  // namespace hbar::solvers
