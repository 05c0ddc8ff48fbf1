#pragma once

#include "hbar/adjoint/objective.h"

namespace hbar {

using TermPointer = std::shared_ptr<const ObjectiveTerm>;

/// ½ weight Σ_{k=1…N} ‖v_k‖² over all auxiliary variables.
[[nodiscard]] TermPointer squared_variables(double weight = 1.0);

/// ½ weight Σ_{k=1…N} ‖tactile_k‖² over all sensor readings.
[[nodiscard]] TermPointer squared_tactile(double weight = 1.0);

/// ½ weight ‖q_N‖².
[[nodiscard]] TermPointer squared_final_position(double weight = 1.0);

/// ½ weight Σ_{k=1…N} ‖q_k − target_k‖².
///
/// @param target  column k − 1 is step k's target, or one column for all     [dof x N or 1]
[[nodiscard]] TermPointer tracking(Eigen::MatrixXd target, double weight = 1.0);

/// ½ weight Σ_{k=1…N} ‖v_k − target_k‖² on the auxiliary variables.
///
/// @param target  column k − 1 is step k's target, or one column for all     [variables x N or 1]
[[nodiscard]] TermPointer variable_tracking(Eigen::MatrixXd target, double weight = 1.0);

/// ½ (weight_q ‖q_N − q‖² + weight_qdot ‖q̇_N − q̇‖²).
///
/// @param q, qdot  wanted state at the end                                   [dof]
[[nodiscard]] TermPointer terminal_state(Eigen::VectorXd q, Eigen::VectorXd qdot, double weight_q,
                                         double weight_qdot);

/// ½ weight h Σ_k ‖u_k‖².
[[nodiscard]] TermPointer effort(double weight = 1.0);

/// ½ weight h Σ_{k=1…N} ‖q̇_k‖².
[[nodiscard]] TermPointer squared_velocity(double weight = 1.0);

/// A term of the user's own: a value, and a function that adds its partials (check_gradient tells
/// whether they agree).
[[nodiscard]] TermPointer user_term(
    std::string name, std::function<double(const TrajectoryValues&)> value,
    std::function<void(const TrajectoryValues&, TrajectoryPartials&)> add_partials);

}  // namespace hbar
