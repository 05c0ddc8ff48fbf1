#pragma once

#include "hbar/adjoint/terms/objective.h"

namespace hbar {

class Horizon;
class Model;
struct Trajectory;

/// ∂Ψ/∂q̄ with rates and measurements expressed by the coordinates they depend on: ȳ of (20), and
/// the direct contributions of q̇₀, p and u.
struct StageWeights {
  Eigen::MatrixXd q_bar;  ///< per stage, column 0 is q₀      [dof x stages]
  Eigen::VectorXd qdot0;  ///<                                [dof]
  Eigen::VectorXd p;      ///<                                [parameters]
  Eigen::MatrixXd u;      ///<                                [controls x steps]
};

/// @param trajectory  complete, of this horizon
[[nodiscard]] StageWeights stage_weights(const Horizon& horizon, const Trajectory& trajectory,
                                         const TrajectoryPartials& partials);

/// Adds (∂q̇_s/∂q̄)ᵀ y to the stages that q̇_s depends on; for stage 0, to `out.qdot0`.
///
/// @param y  [dof]
void add_rate_weights(const Model& model, const Trajectory& trajectory, int stage,
                      const Eigen::VectorXd& y, StageWeights& out);

}  // namespace hbar
