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
  /// log(‖d_k‖ / ‖d_{k−1}‖) / log(‖d_{k−1}‖ / ‖d_{k−2}‖): 2 if it converges quadratically; 0 for
  /// the first two.
  double order = 0.0;
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

/// CPU time of one iteration of Ipopt, all-at-once with the exact Hessian.
struct IterationCost {
  int steps = 0;
  double set_up = 0.0;     ///< of the program, once, s
  double total = 0.0;      ///< of an iteration, s; what follows are its parts
  double values = 0.0;     ///< objective, constraints and residuals, s
  double first = 0.0;      ///< gradient and Jacobian, s
  double hessian = 0.0;    ///< s
  double optimiser = 0.0;  ///< Ipopt and its linear systems, s
};

/// Takes the fastest of several runs of a few iterations for each number of steps.
[[nodiscard]] std::vector<IterationCost> measure_scaling(const std::filesystem::path& scene,
                                                         const std::vector<int>& steps);

/// A line for each, and the exponents of growth.
[[nodiscard]] std::string scaling_table(const std::vector<IterationCost>& costs);

}  // namespace hbar::swing_up
