#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/programs/trajectory_problem.h"

namespace hbar {

/// "elbow", …, "elbow rate", …                                                [2 dof]
[[nodiscard]] std::vector<std::string> state_names(const Model& model);

/// Typical sizes of changes of q and q̇.                                      [2 dof]
[[nodiscard]] Eigen::VectorXd state_scale(const TrajectoryProblem& problem);

/// `vector`, or `count` times `value` if it is empty.
/// @throws InvalidInput naming `name` if it has another size
[[nodiscard]] Eigen::VectorXd filled(const Eigen::VectorXd& vector, Eigen::Index count,
                                     double value, const char* name);

}  // namespace hbar
