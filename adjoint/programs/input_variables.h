#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/trajectory_problem.h"
#include "hbar/solvers/nlp/nlp.h"

namespace hbar {

/// The variables that every transcription of a problem begins with, and what they stand for:
///
///     x = [ design d | held controls, block by block | q₀ | q̇₀ | … ]      (q₀, q̇₀ if free)
///
/// A transcription appends its own variables.
class InputVariables {
 public:
  /// @param problem  must outlive this object
  /// @throws InvalidInput if its parts do not fit together
  explicit InputVariables(const TrajectoryProblem& problem);

  [[nodiscard]] Eigen::Index size() const { return variables_.start.size(); }
  [[nodiscard]] const solvers::NlpVariables& variables() const { return variables_; }

  [[nodiscard]] Eigen::Index design_count() const { return design_count_; }
  /// Number of controls at one instant.
  [[nodiscard]] Eigen::Index control_count() const { return control_count_; }
  [[nodiscard]] int block_count() const { return blocks_; }
  /// The block of controls that acts during a step.
  [[nodiscard]] int block_of_step(int step) const { return step / problem_.controls.hold; }
  /// Place in x of a block's first control.
  [[nodiscard]] Eigen::Index control_place(int block) const {
    return design_count_ + block * control_count_;
  }
  [[nodiscard]] bool state_is_free() const { return problem_.initial.has_value(); }
  /// Place in x of q₀; q̇₀ follows. Only if state_is_free().
  [[nodiscard]] Eigen::Index state_place() const { return control_place(blocks_); }

  /// The simulation inputs that x stands for.
  [[nodiscard]] Inputs inputs(const Eigen::VectorXd& x) const;
  /// The design variables of x.                                                         [d]
  [[nodiscard]] Eigen::VectorXd design(const Eigen::VectorXd& x) const {
    return x.head(design_count_);
  }
  /// The design variables that a parameter can depend on, ascending.
  [[nodiscard]] const std::vector<Eigen::Index>& designs_of(Eigen::Index parameter) const {
    return designs_of_[static_cast<std::size_t>(parameter)];
  }
  /// Adds (∂inputs/∂x)ᵀ of a gradient to the head of `out`.
  ///
  /// @param map_jacobian  of the design map at x                           [parameters x d]
  void add_pull_back(const Gradient& gradient, const Eigen::MatrixXd& map_jacobian,
                     Eigen::Ref<Eigen::VectorXd> out) const;
  /// ½ w Σ ((d − start) / scale)², to be added to the objective.
  [[nodiscard]] double design_cost(const Eigen::VectorXd& x) const;
  /// Adds its gradient.
  void add_design_cost_gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Its second derivative with respect to d_i.
  [[nodiscard]] double design_cost_curvature(Eigen::Index i) const;

  /// Refuses a term that reads a step outside the trajectory, naming its row.
  void require_places(const ConstraintTerm& term) const;

 private:
  void describe_design_and_controls();
  void describe_state();

  const TrajectoryProblem& problem_;
  Eigen::Index design_count_ = 0;
  Eigen::Index control_count_ = 0;
  int blocks_ = 0;
  std::vector<std::vector<Eigen::Index>> designs_of_;  // per parameter
  solvers::NlpVariables variables_;
};

}  // namespace hbar
