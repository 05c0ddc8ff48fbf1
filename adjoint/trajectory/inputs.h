#pragma once

#include <Eigen/Core>

namespace hbar {

/// What a simulation is a function of. Time runs along columns.
struct Inputs {
  Eigen::VectorXd p;   ///< design parameters, in the ParameterSet's order      [parameters]
  Eigen::MatrixXd u;   ///< controls, column k acts during step k               [controls x steps]
  Eigen::VectorXd q0;  ///< initial coordinates                                 [dof]
  Eigen::VectorXd qdot0;  ///< their rates                                         [dof]
};

/// The step whose control measurements at the end of step k − 1 read: the one that ends there; at
/// the start, the first.
[[nodiscard]] constexpr int measured_step(int k) { return k > 0 ? k - 1 : 0; }

}  // namespace hbar
