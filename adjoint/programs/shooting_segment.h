#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/derivatives/second_order.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/programs/trajectory_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar {

/// The variables of a program that a segment of the horizon depends on, as runs of x:
/// [ design | its blocks of controls | its first state, if that is a variable ]. Its own vectors
/// have the same order.
struct SegmentColumns {
  Eigen::Index design = 0;         ///< number of design variables; they begin x
  Eigen::Index first_control = 0;  ///< place in x of its first block
  Eigen::Index controls = 0;       ///< number of control variables
  Eigen::Index first_state = -1;   ///< place in x of q; q̇ follows; −1 if no variable
  Eigen::Index state = 0;          ///< 2 dof, or 0

  [[nodiscard]] Eigen::Index size() const { return design + controls + state; }
  /// Place in x of the segment's i-th variable.
  [[nodiscard]] Eigen::Index place(Eigen::Index i) const {
    if (i < design) {
      return i;
    }
    return i < design + controls ? first_control + i - design : first_state + i - design - controls;
  }
  /// The inverse: which of the segment's variables is at a place of x.
  [[nodiscard]] Eigen::Index variable(Eigen::Index at) const {
    if (at < design) {
      return at;
    }
    return state > 0 && at >= first_state ? at - first_state + design + controls
                                          : at - first_control + design;
  }
};

/// A part of the horizon that is simulated by itself, with everything that shooting needs from it.
///
/// Belongs to one thread at a time; different segments are independent.
class ShootingSegment {
 public:
  /// @param whole       of the whole horizon; model and parameters are shared
  /// @param first_step  of the horizon
  /// @param steps       of the segment
  /// @param hold        steps per block of controls, counted from the horizon's start
  ShootingSegment(const Horizon& whole, int first_step, int steps, int hold,
                  SegmentColumns columns);

  /// Simulates. Where that fails, failure() says why.
  ///
  /// @param inputs  of this segment: u has only its own steps
  void simulate(const Inputs& inputs);
  /// Why the last point cannot be simulated; empty if it can.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// Values at the last point, if it could be simulated; the first column is the segment's first
  /// state.
  [[nodiscard]] const TrajectoryValues& values() const { return values_; }

  /// (∂values/∂inputs)ᵀ of weights: one adjoint sweep.
  ///
  /// @param weights  on values(); those on the first column are read only if the state is a
  ///                 variable
  [[nodiscard]] Gradient pull_back(const TrajectoryPartials& weights) {
    return adjoint_.pull_back(trajectory_, weights);
  }
  /// Tangents of values() with respect to the segment's variables, in the order of SegmentColumns.
  const Tangents& differentiate(const Eigen::MatrixXd& map_jacobian);
  [[nodiscard]] const Tangents& tangents() const { return tangents_; }

  /// Second derivative of weights·values with respect to the segment's variables, the weights and
  /// the design map's Jacobian being constant.
  ///
  /// @param by_p  receives the derivative of weights·values with respect to the parameters
  ///                                                                       [parameters]
  [[nodiscard]] Eigen::MatrixXd curvature(const TrajectoryPartials& weights,
                                          const Eigen::MatrixXd& map_jacobian,
                                          Eigen::VectorXd& by_p);

  [[nodiscard]] const SegmentColumns& columns() const { return columns_; }
  [[nodiscard]] int first_step() const { return first_step_; }
  [[nodiscard]] int step_count() const { return horizon().steps(); }
  /// Whether exponential coordinates changed chart within the segment.
  [[nodiscard]] bool changes_chart() const { return !trajectory_.chart_switches.empty(); }

 private:
  [[nodiscard]] const Horizon& horizon() const { return simulator_.horizon(); }
  /// The segment's control variable that acts as control `i` during its step `k`.
  [[nodiscard]] Eigen::Index control_variable(int k, Eigen::Index i) const;
  [[nodiscard]] Inputs direction(Eigen::Index variable, const Eigen::MatrixXd& map_jacobian) const;

  int first_step_ = 0;
  int hold_ = 1;
  SegmentColumns columns_;
  Simulator simulator_;
  ValueReader reader_;
  AdjointSweep adjoint_;
  TangentSweep tangent_;
  SecondOrderSweep second_;
  Trajectory trajectory_;
  TrajectoryValues values_;
  Tangents tangents_;
  std::string failure_;
};

}  // namespace hbar
