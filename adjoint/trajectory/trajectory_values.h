#pragma once

#include <Eigen/Core>

namespace hbar {

/// What objectives, constraints and result files read. Time runs along columns, k = 0 … N.
struct TrajectoryValues {
  double h = 0.0;            ///< nominal time step
  Eigen::MatrixXd q;         ///< rad or length                               [dof x N+1]
  Eigen::MatrixXd qdot;      ///<                                             [dof x N+1]
  Eigen::MatrixXd v;         ///< auxiliary variables, length                 [variables x N+1]
  Eigen::MatrixXd tactile;   ///< sensor readings, force                   [readings x N+1]
  Eigen::MatrixXd measured;  ///< measurements                               [measured x N+1]
  Eigen::MatrixXd u;         ///< controls                                    [controls x N]
  Eigen::VectorXd p;         ///< design parameters                           [parameters]
};

}  // namespace hbar
