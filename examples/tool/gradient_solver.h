#pragma once

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/load_problem.h"

namespace hbar::tool {

/// Names that --linear-solver takes: sweep, auto and what this build has for the gradient's system.
[[nodiscard]] std::vector<std::string> linear_solver_names();

/// The gradient of a problem along its trajectory, computed with the chosen linear solver.
///
/// @throws InvalidInput if the scene names a solver that this build does not have
/// @throws NumericalFailure if the system cannot be solved
[[nodiscard]] Gradient gradient_of(const LoadedProblem& loaded, const Trajectory& trajectory);

}  // namespace hbar::tool
