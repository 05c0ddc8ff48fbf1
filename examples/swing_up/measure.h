#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "examples/common/optimise.h"
#include "swing_up.h"

namespace hbar::swing_up {

/// How a Newton method's last steps converge.
struct TailStep {
  int iteration = 0;
  double step_norm = 0.0;  ///< ‖d‖∞ in Ipopt's scaled variables
  double order = 0.0;      ///< log ‖d_k‖ / log ‖d_{k−1}‖, 2 if it converges quadratically
};

/// The last full steps of a run whose norm is below 1 and above rounding.
[[nodiscard]] std::vector<TailStep> convergence_tail(
    const std::vector<solvers::IterationInfo>& iterations);

/// Solves with each kind of Hessian from the same start, and once more with the exact one and a
/// barrier that does not move, to see the order of convergence. Prints tables.
///
/// @param arguments  each kind writes into a folder of its own name in arguments.out
[[nodiscard]] example::ExitCode compare_hessians(const SwingUp& swing_up,
                                                 const example::OptimiseArguments& arguments);

/// Times of one iteration of Ipopt, all-at-once with the exact Hessian.
struct IterationCost {
  int steps = 0;
  double set_up = 0.0;     ///< until Ipopt starts, s
  double total = 0.0;      ///< CPU time of an iteration, s; the rest are parts of it by the clock
  double values = 0.0;     ///< residuals and what the terms read
  double first = 0.0;      ///< gradient and Jacobian
  double hessian = 0.0;    ///<
  double optimiser = 0.0;  ///< Ipopt and its linear systems
};

/// Takes the fastest of several runs of a few iterations for each number of steps.
[[nodiscard]] std::vector<IterationCost> measure_scaling(const std::filesystem::path& scene,
                                                         const std::vector<int>& steps);

/// A line for each, and the exponents of growth.
[[nodiscard]] std::string scaling_table(const std::vector<IterationCost>& costs);

}  // namespace hbar::swing_up
