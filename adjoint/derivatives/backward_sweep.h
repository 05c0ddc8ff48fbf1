#pragma once

#include <functional>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// A trajectory with numbers of type S: its own values, or those values with slopes. Borrows
/// everything.
template <Scalar S>
struct SweptTrajectory {
  const Trajectory& trajectory;
  const Applied<S>& applied;
  const MatrixX<S>& q;     ///< per stage                                     [dof x stages]
  const MatrixX<S>& qdot;  ///<                                               [dof x stages]
  const MatrixX<S>& u;     ///< per step                                      [controls x N]
};

/// Weights on the values of a trajectory, as TrajectoryPartials. Borrows everything.
template <Scalar S>
struct SweptWeights {
  const MatrixX<S>& q;         ///<                                           [dof x N+1]
  const MatrixX<S>& qdot;      ///<                                           [dof x N+1]
  const MatrixX<S>& measured;  ///<                                           [measured x N+1]
  const MatrixX<S>& u;         ///<                                           [controls x N]
  const VectorX<S>& p;         ///<                                           [parameters]
};

/// The adjoint of a trajectory, stage by stage from its end: H̄ᵀ z̄ = ȳ (20) by block substitution
/// and the contraction (21), without forming H̄ or ∂ḡ/∂p. With dual numbers it is the second
/// adjoint (doc/formulations.md). The caller decides how a stage's block is solved.
///
/// Holds its workspace for one horizon and belongs to one thread at a time.
template <Scalar S>
class BackwardSweep {
 public:
  /// Solves H_ssᵀ z = y for stage s, at which `stage` is linearised, and leaves `stage` pulled back
  /// by z.
  using SolveBlock =
      std::function<void(int s, const VectorX<S>& y, StageResidual<S>& stage, VectorX<S>& z)>;

  explicit BackwardSweep(Horizon horizon);

  /// Runs the sweep; the accessors below then give the results.
  ///
  /// @throws Interrupted if the horizon's stop flag is set before a stage
  void run(const SweptTrajectory<S>& at, const SweptWeights<S>& weights, const SolveBlock& solve);

  // d(weights·values) by each input, after run().
  [[nodiscard]] const VectorX<S>& by_p() const { return p_bar_; }   ///< [parameters]
  [[nodiscard]] const MatrixX<S>& by_u() const { return u_bar_; }   ///< [controls x N]
  [[nodiscard]] auto by_q0() const { return q_bar_.col(0); }        ///< [dof]
  [[nodiscard]] auto by_qdot0() const { return qdot_bar_.col(0); }  ///< [dof]

 private:
  void set_point(const SweptTrajectory<S>& at, int s);
  void add_outputs(const SweptTrajectory<S>& at, const SweptWeights<S>& weights, int k,
                   const Instant<S>& instant);
  void sweep_stage(const SweptTrajectory<S>& at, int s, const SolveBlock& solve);

  Horizon horizon_;
  History history_;
  StageResidual<S> stage_;
  StagePoint<S> point_;
  Measurements<S> measurements_;
  InstantMotion<S> start_;  // where no stage ends
  MatrixX<S> q_bar_;        // ∂L/∂q per stage, so far
  MatrixX<S> qdot_bar_;     // ∂L/∂q̇ per stage, so far
  MatrixX<S> u_bar_;
  VectorX<S> p_bar_;
  VectorX<S> g_, y_, z_, y_qdot_, y_a_, qdot_past_, a_past_;
  StepStart<S> y_start_;
};

}  // namespace hbar
