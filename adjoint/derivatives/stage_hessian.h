#pragma once

#include <vector>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// Second derivatives at one stage. The letters say with respect to what: coordinates q, rates v,
/// accelerations a, controls u, design variables d; sq, sv are q, v at the step's start.
struct StageCurvature {
  Eigen::MatrixXd qq, qv, qa, vv;        ///< by q, q̇ and a                    [dof x dof]
  Eigen::MatrixXd uq, uv;                ///< of what is measured              [controls x dof]
  Eigen::MatrixXd dq, dv, da, dsq, dsv;  ///< by d and q, q̇, a, start          [designs x dof]
  Eigen::MatrixXd du;                    ///<                                  [designs x controls]
  Eigen::MatrixXd dd;                    ///<                                  [designs x designs]
  Eigen::VectorXd by_p;  ///< first derivative by p, if there are designs        [parameters]
};

/// Second derivatives of z·g(q, q̇, a, start, u, p) + y·measured(q, q̇, u, p) at one stage,
/// contracted with z and y before anything is stored: a dual number runs through the transposed
/// derivative once per coordinate, rate and design variable. With respect to a, start and u only
/// the mixed second derivatives listed above are non-zero.
///
/// Parameters move with design variables d along a constant ∂p/∂d. Holds its workspace for one
/// horizon and belongs to one thread at a time.
class StageHessian {
 public:
  /// @param designs  number of design variables
  StageHessian(const Horizon& horizon, Eigen::Index designs);

  /// Sets the parameters and how they depend on the design variables.
  ///
  /// @param map_jacobian  ∂p/∂d                                    [parameters x designs]
  void set_parameters(const Eigen::VectorXd& p, const Eigen::MatrixXd& map_jacobian);

  /// Evaluates at a stage of a trajectory computed with these parameters.
  ///
  /// @param z  weights on g                                                      [dof]
  /// @param y  weights on what is measured at the stage's end; null: none           [measured]
  /// @returns  valid until the next evaluation
  const StageCurvature& evaluate(const Trajectory& trajectory, int stage, const Eigen::VectorXd& z,
                                 const Eigen::VectorXd* y);
  /// The same for the initial state, where only outputs contribute.
  const StageCurvature& evaluate_start(const Trajectory& trajectory, const Eigen::VectorXd& y);

 private:
  void set_zero();
  void evaluate_design(Eigen::Index i, bool with_stage);
  void linearize_stage(const Mechanism<Dual>& mechanism);
  void linearize_outputs(const Mechanism<Dual>& mechanism, const VectorX<Dual>& p);

  Horizon horizon_;
  StageResidual<Dual> stage_;
  Measurements<Dual> measurements_;
  InstantMotion<Dual> instants_;
  History history_;
  StagePoint<double> at_;
  StagePoint<Dual> point_;
  Mechanism<Dual> still_;                // parameters that do not move
  std::vector<Mechanism<Dual>> moving_;  // along each design variable
  std::vector<VectorX<Dual>> moving_p_;
  VectorX<Dual> still_p_;
  Eigen::MatrixXd map_jacobian_;
  StageCurvature out_;
  VectorX<Dual> z_;
  VectorX<Dual> y_;
  bool has_outputs_ = false;
  VectorX<Dual> g_, by_q_, by_qdot_, by_u_, by_p_;
};

}  // namespace hbar
