#pragma once

#include <Eigen/Core>

namespace hbar {

/// The inputs of a simulation. Time runs along columns.
struct Inputs {
  Eigen::VectorXd p;   ///< design parameters, in the ParameterSet's order      [parameters]
  Eigen::MatrixXd u;   ///< controls, column k acts during step k               [controls x steps]
  Eigen::VectorXd q0;  ///< initial coordinates                                 [dof]
  Eigen::VectorXd qdot0;  ///< their rates                                         [dof]
};

/// The step whose control is read by measurements at time k h: the step that ends there; at k = 0,
/// the first.
[[nodiscard]] constexpr int measured_step(int k) { return k > 0 ? k - 1 : 0; }

}  // namespace hbar
