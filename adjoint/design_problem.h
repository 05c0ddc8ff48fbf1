#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/constraint.h"
#include "hbar/adjoint/design_map.h"
#include "hbar/adjoint/gradient.h"
#include "hbar/adjoint/tangent.h"
#include "hbar/solvers/nlp.h"

namespace hbar {

/// Controls that are held for several steps: block b acts during steps b·hold … (b+1)·hold − 1.
struct HeldControls {
  int hold = 1;           ///< steps per block, > 0; the last block may be shorter
  Eigen::MatrixXd start;  ///< empty: zeros                               [controls x blocks or 1]
  Eigen::VectorXd lower;  ///< empty: none                                           [controls]
  Eigen::VectorXd upper;  ///< empty: none                                           [controls]
  Eigen::VectorXd scale;  ///< typical size of a change; empty: ones                 [controls]
};

/// What a DesignProblem is made of.
struct DesignProblemParts {
  Simulator simulator;
  std::shared_ptr<const DesignMap> map;        ///< onto the simulator's parameters
  Objective objective;                         ///< of trajectory, controls and parameters
  std::vector<ConstraintPointer> constraints;  ///< their rows follow each other in this order
  HeldControls controls;
  Eigen::VectorXd q0;     ///< fixed; empty: zeros                                      [dof]
  Eigen::VectorXd qdot0;  ///< fixed; empty: zeros                                      [dof]
  /// w of ½ w Σ ((d − start) / scale)², which is added to the objective; ≥ 0.
  double design_weight = 0.0;
};

/// Where a DesignProblem spent its time.
struct DesignProblemTimes {
  double simulation = 0.0;  ///< s
  double gradient = 0.0;    ///< s
  double jacobian = 0.0;    ///< s
  int simulations = 0;
  int gradients = 0;
  int jacobians = 0;
};

/// Design and control by single shooting: x = [design variables d; held controls, block by block],
/// and the trajectory is what the simulation makes of them.
///
/// A point is simulated once, whatever is asked there. The gradient is one adjoint sweep, the
/// Jacobian one tangent sweep with a direction per variable. A row that reads the trajectory up to
/// step k has no entry for the controls of later steps. Where the parameters are impossible or the
/// simulation fails, an evaluation throws EvaluationError.
class DesignProblem final : public solvers::Nlp {
 public:
  /// @throws InvalidInput if parts do not fit together: sizes, or places beyond the trajectory
  explicit DesignProblem(DesignProblemParts parts);

  [[nodiscard]] const solvers::NlpVariables& variables() const override { return variables_; }
  [[nodiscard]] const solvers::NlpConstraints& constraint_limits() const override {
    return limits_;
  }
  [[nodiscard]] const solvers::SparsityPattern& jacobian_pattern() const override {
    return pattern_;
  }
  [[nodiscard]] double objective(const Eigen::VectorXd& x) override;
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override;
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override;
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override;

  /// The trajectory's values at x.
  /// @throws EvaluationError where it cannot be simulated
  [[nodiscard]] const TrajectoryValues& trajectory_values(const Eigen::VectorXd& x);
  /// The design variables of x.                                                         [d]
  [[nodiscard]] Eigen::VectorXd design(const Eigen::VectorXd& x) const;
  /// What x simulates.
  [[nodiscard]] Inputs inputs(const Eigen::VectorXd& x) const;

  [[nodiscard]] const DesignProblemParts& parts() const { return parts_; }
  [[nodiscard]] const DesignProblemTimes& times() const { return times_; }
  /// Number of blocks of controls.
  [[nodiscard]] int block_count() const { return blocks_; }

 private:
  [[nodiscard]] Eigen::Index design_count() const { return parts_.map->variables().size(); }
  [[nodiscard]] Eigen::Index control_count() const {
    return parts_.simulator.model().control_count();
  }
  void check_parts();
  void describe_variables();
  void describe_constraints();
  /// How many blocks a place may depend on: the first ones, or with kU one alone.
  [[nodiscard]] std::pair<int, int> blocks_of(const PartialPlace& place) const;
  void check_place(const ConstraintTerm& term, const PartialPlace& place) const;
  /// Simulates x unless that was the last point.
  void move_to(const Eigen::VectorXd& x);
  [[nodiscard]] Directions directions(const Eigen::VectorXd& x) const;

  DesignProblemParts parts_;
  int blocks_ = 0;
  solvers::NlpVariables variables_;
  solvers::NlpConstraints limits_;
  solvers::SparsityPattern pattern_;
  AdjointSweep adjoint_;
  TangentSweep tangent_;
  DesignProblemTimes times_;

  Eigen::VectorXd x_;    // the last point
  std::string failure_;  // why it cannot be simulated; empty if it can
  Trajectory trajectory_;
  TrajectoryValues values_;
};

}  // namespace hbar
