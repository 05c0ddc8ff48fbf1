#pragma once

#include "hbar/adjoint/programs/input_variables.h"

namespace hbar {

/// A first guess of the motion at the ends of the steps, q above q̇: from `q_guess` with difference
/// quotients for the rates or, if that is empty, the motion simulated from the start of `head`;
/// rest from where that fails.
///
/// @param q_guess  empty, or                                                  [dof x N+1]
/// @returns                                                                   [2 dof x N+1]
/// @throws InvalidInput if q_guess has another shape, is not finite or does not begin with q0 (by
///         1e-6 of it or of 1), or exponential coordinates change chart in the simulation
[[nodiscard]] Eigen::MatrixXd guess_states(const TrajectoryProblem& problem,
                                           const InputVariables& head,
                                           const Eigen::MatrixXd& q_guess);

}  // namespace hbar
