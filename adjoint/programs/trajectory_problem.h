#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hbar/adjoint/design/design_map.h"
#include "hbar/adjoint/terms/constraint.h"
#include "hbar/adjoint/terms/objective.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// Controls that are held for several steps: block b acts during steps b·hold … (b+1)·hold − 1.
struct HeldControls {
  int hold = 1;           ///< steps per block, > 0; the last block may be shorter
  Eigen::MatrixXd start;  ///< empty: zeros                               [controls x blocks or 1]
  Eigen::VectorXd lower;  ///< empty: none; of all blocks, or block by block
                          ///<                                    [controls or controls·blocks]
  Eigen::VectorXd upper;  ///< the same; where lower = upper a control is fixed
  Eigen::VectorXd scale;  ///< typical size of a change; empty: solvers::scale_from_bounds
                          ///<                                    [controls or controls·blocks]
};

/// Bounds of an initial state that is optimised. Where lower = upper a number is held fixed.
struct InitialStateBounds {
  Eigen::VectorXd q_lower;     ///< rad or length                                       [dof]
  Eigen::VectorXd q_upper;     ///<                                                     [dof]
  Eigen::VectorXd qdot_lower;  ///<                                                     [dof]
  Eigen::VectorXd qdot_upper;  ///<                                                     [dof]
};

/// One problem of design, control or both: minimise an objective of a trajectory over design
/// variables d, held controls and, optionally, the initial state, subject to constraints. A
/// Transcription turns it into a nonlinear program in one of three ways.
struct TrajectoryProblem {
  Horizon horizon;                                  ///< scene, horizon, integrator, measurements
  DesignMapPointer map;                             ///< onto the horizon's parameters
  Objective objective;                              ///< of trajectory, controls and parameters
  std::vector<ConstraintPointer> constraints = {};  ///< their rows follow in this order
  HeldControls controls = {};
  Eigen::VectorXd q0 = {};     ///< fixed, or where the optimisation starts; empty: zeros  [dof]
  Eigen::VectorXd qdot0 = {};  ///< the same                                               [dof]
  /// Set if the initial state is optimised as well.
  std::optional<InitialStateBounds> initial = std::nullopt;
  Eigen::VectorXd q_scale = {};     ///< typical size of a change of q; empty: ones     [dof]
  Eigen::VectorXd qdot_scale = {};  ///< the same of q̇                                  [dof]
  /// w of ½ w Σ ((d − start) / scale)², which is added to the objective; ≥ 0.
  double design_weight = 0.0;
};

}  // namespace hbar
