#pragma once

#include <memory>
#include <optional>

#include "hbar/adjoint/programs/entry_plan.h"
#include "hbar/adjoint/programs/input_variables.h"

namespace hbar {

/// Where a transcription spent its time.
struct TranscriptionTimes {
  double simulation = 0.0;  ///< s; of kAllAtOnce: residuals and values
  double gradient = 0.0;    ///< s
  double jacobian = 0.0;    ///< s
  double hessian = 0.0;     ///< s
  int simulations = 0;
  int gradients = 0;
  int jacobians = 0;
  int hessians = 0;
};

/// A TrajectoryProblem as a nonlinear program. Its x begins with InputVariables; its constraints
/// begin with the problem's own rows.
///
/// Each point is simulated once, however many functions are evaluated there. Where the parameters
/// are impossible or the simulation fails, an evaluation throws EvaluationError.
/// hessian_pattern(kExact) throws InvalidInput if a term or the design map has no second
/// derivatives, naming it; kGaussNewton is the second derivative of the objective with respect to
/// the trajectory's values, mapped to x by first derivatives, and needs only the objective's second
/// partials.
class Transcription : public solvers::Nlp {
 public:
  [[nodiscard]] const solvers::NlpVariables& variables() const final { return variables_; }
  [[nodiscard]] const solvers::NlpConstraints& constraint_limits() const final { return limits_; }
  [[nodiscard]] const solvers::SparsityPattern& jacobian_pattern() const final { return pattern_; }

  [[nodiscard]] const solvers::SparsityPattern& hessian_pattern(solvers::HessianKind kind) final {
    return plan(kind).entries.pattern();
  }

  /// The trajectory's values at x.
  /// @throws EvaluationError if it cannot be simulated
  [[nodiscard]] virtual const TrajectoryValues& trajectory_values(const Eigen::VectorXd& x) = 0;

  /// The simulation inputs that x stands for.
  [[nodiscard]] Inputs inputs(const Eigen::VectorXd& x) const {
    require_size(x);
    return head_.inputs(x);
  }
  /// The design variables of x.                                                         [d]
  [[nodiscard]] Eigen::VectorXd design(const Eigen::VectorXd& x) const {
    require_size(x);
    return head_.design(x);
  }
  [[nodiscard]] const TrajectoryProblem& problem() const { return problem_; }
  [[nodiscard]] const InputVariables& input_variables() const { return head_; }
  [[nodiscard]] const TranscriptionTimes& times() const { return times_; }

 protected:
  /// Sets up the head of x and the problem's own rows.
  /// @throws InvalidInput if the problem's parts do not fit together
  explicit Transcription(const TrajectoryProblem& problem);

  /// Appends variables after the head.
  void add_variables(const solvers::NlpVariables& more);
  /// Appends equations c = 0 after the problem's own rows.
  void add_equations(const std::vector<std::string>& names);
  /// @throws InvalidInput if the size of x is not the number of variables
  void require_size(const Eigen::VectorXd& x) const;
  /// @throws InvalidInput unless there is a multiplier for each constraint
  void require_multipliers(const Eigen::VectorXd& lambda) const;
  /// Number of the problem's own rows.
  [[nodiscard]] Eigen::Index own_rows() const { return own_rows_; }
  /// Values of the problem's own rows.
  void own_constraints(const TrajectoryValues& values, Eigen::VectorXd& c) const;
  /// σ ∂Ψ + λᵀ ∂c with respect to the values, for the objective's terms and the problem's own rows.
  [[nodiscard]] TrajectoryPartials lagrangian_partials(const TrajectoryValues& values, double sigma,
                                                       const Eigen::VectorXd& lambda) const;

  /// The entries of x that a number of the trajectory depends on; always the same.
  [[nodiscard]] virtual std::vector<Eigen::Index> columns_of(const ValuePlace& place) const = 0;
  /// The number's derivatives with respect to columns_of(place), at the point differentiated last.
  virtual void derivatives_of(const ValuePlace& place, std::vector<double>& out) = 0;

  /// Declares the Jacobian of the problem's own rows, and fills it in the same order.
  void add_own_rows(EntryPlan& entries) const;
  void put_own_rows(const TrajectoryValues& values, EntryPlan& entries);

  /// Declares Σ second (a bᵀ + b aᵀ), counted once where a is b, with a and b the derivatives of
  /// two numbers with respect to x, place by place; and fills it in the same order.
  virtual void add_second_places(const std::vector<SecondPlace>& places, EntryPlan& entries) const;
  virtual void put_second_partials(const std::vector<SecondPlace>& places,
                                   const Eigen::VectorXd& second, EntryPlan& entries);

  /// The Hessian's set-up for one kind.
  struct HessianPlan {
    EntryPlan entries;
    std::vector<SecondPlace> objective;  // second places of the objective's terms
    std::vector<SecondPlace> own;        // and of the problem's own rows, `row` over all of them
  };
  /// The set-up for a kind, made on first use.
  /// @throws InvalidInput naming a term, or the design map, that has no second derivatives
  [[nodiscard]] HessianPlan& plan(solvers::HessianKind kind);
  /// Declares what kExact adds after the terms' second partials and the design cost.
  virtual void add_curvature(EntryPlan& entries) const = 0;
  /// Fills in the contributions of the terms' second partials and the design cost.
  void begin_values(HessianPlan& plan, const TrajectoryValues& values, double sigma,
                    const Eigen::VectorXd& lambda, Eigen::VectorXd& out);

  TrajectoryProblem problem_;
  InputVariables head_;
  solvers::NlpVariables variables_;
  solvers::NlpConstraints limits_;
  solvers::SparsityPattern pattern_;
  TranscriptionTimes times_;

 private:
  [[nodiscard]] Eigen::VectorXd own_second_partials(const TrajectoryValues& values,
                                                    const Eigen::VectorXd& lambda) const;

  [[nodiscard]] HessianPlan make_plan(solvers::HessianKind kind) const;

  Eigen::Index own_rows_ = 0;
  std::optional<HessianPlan> exact_;
  std::optional<HessianPlan> gauss_newton_;
};

}  // namespace hbar
