#pragma once

#include "hbar/adjoint/stage/stage_residual.h"
#include "hbar/adjoint/trajectory/trajectory.h"

namespace hbar {

/// How a stage's rates and step start depend on earlier stages, through changes of chart.
///
/// Along an edge (stage ← earlier) coordinates pass unchanged, except for exponential nodes whose
/// chart changed in between: their r becomes φ(r), and their rate Dφ(r) ṙ.
///
/// Borrows the model. Holds a little workspace and belongs to one thread at a time.
class History {
 public:
  explicit History(const Model& model)
      : model_(model), qdot_past_(model.dof()), a_past_(model.dof()) {}

  /// Nodes whose chart differs between two stages, i.e. that switched an odd number of times.
  void switched_nodes(const Trajectory& trajectory, int earlier, int stage,
                      std::vector<int>& nodes) const;

  /// The parts of q̇ and q̈ that earlier stages determine, and the state at the step's start.
  ///
  /// @param qdot_past  Σ weight q_j                                              [dof]
  /// @param a_past     Σ weight q̇_j                                              [dof]
  void gather(const Trajectory& trajectory, int stage, Eigen::VectorXd& qdot_past,
              Eigen::VectorXd& a_past, StepStart<double>& start) const {
    gather<double>(trajectory, trajectory.q, trajectory.qdot, stage, qdot_past, a_past, start);
  }
  /// The same for coordinates and rates other than the trajectory's own, such as dual numbers for
  /// its tangent.
  ///
  /// @param q, qdot  per stage                                        [dof x stages]
  template <Scalar S>
  void gather(const Trajectory& trajectory, const MatrixX<S>& q, const MatrixX<S>& qdot, int stage,
              VectorX<S>& qdot_past, VectorX<S>& a_past, StepStart<S>& start) const;

  /// q̇ and q̈ of a point whose q is set: q̇ = rate q + qdot_past, q̈ = rate q̇ + a_past.
  template <Scalar S>
  static void set_rates(const VectorX<S>& qdot_past, const VectorX<S>& a_past,
                        StagePoint<S>& point) {
    point.qdot = point.rate * point.q + qdot_past;
    point.a = point.rate * point.qdot + a_past;
  }

  /// Sets `point` to a stage of a trajectory.
  void set_point(const Trajectory& trajectory, int stage, StagePoint<double>& point);

  /// Transpose of gather: weights on its three results become weights on earlier states.
  ///
  /// @param y_qdot, y_a       weights on qdot_past, a_past                       [dof]
  /// @param y_start           weights on the step's start
  /// @param q_bar, qdot_bar   weights per stage, added to             [dof x stages]
  void scatter(const Trajectory& trajectory, int stage, const Eigen::VectorXd& y_qdot,
               const Eigen::VectorXd& y_a, const StepStart<double>& y_start, Eigen::MatrixXd& q_bar,
               Eigen::MatrixXd& qdot_bar) const {
    scatter<double>(trajectory, trajectory.q, trajectory.qdot, stage, y_qdot, y_a, y_start, q_bar,
                    qdot_bar);
  }
  template <Scalar S>
  void scatter(const Trajectory& trajectory, const MatrixX<S>& q, const MatrixX<S>& qdot, int stage,
               const VectorX<S>& y_qdot, const VectorX<S>& y_a, const StepStart<S>& y_start,
               MatrixX<S>& q_bar, MatrixX<S>& qdot_bar) const;

 private:
  const Model& model_;
  Eigen::VectorXd qdot_past_;  // of set_point
  Eigen::VectorXd a_past_;
};

}  // namespace hbar
