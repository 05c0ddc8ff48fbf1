#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar::tool {

/// The results of a run, complete or as far as it got.
struct Results {
  std::string status;       ///< "converged", "interrupted", "step_failed", "gradient_failed"
  std::string message;      ///< what went wrong; empty if nothing did
  RolloutReport report;     ///< of the simulation
  TrajectoryValues values;  ///< of the steps done
  std::vector<int> newton;  ///< corrections of each step                  [steps done]
  /// What the contacts did at the steps' ends; empty without contacts.
  std::vector<std::vector<ContactSummary>> contact;  ///< [step 0 … steps done][contact]
  std::optional<double> value;       ///< of the objective; of a whole trajectory only
  std::optional<Gradient> gradient;  ///< only if it was requested and computed
};

/// A run's results as JSON (doc/command.md), a row of numbers on a line, 17 digits each.
/// @throws NumericalFailure if a number is not finite
[[nodiscard]] std::string results_json(const LoadedProblem& loaded, const Results& results);

/// The rows of a gradient check as JSON.
[[nodiscard]] std::string check_json(const LoadedProblem& loaded,
                                     const GradientCheckReport& report);

/// Time, q, qdot, variables and sensor readings of every step as CSV with a header, 17 digits each.
/// The heading of results_csv.
[[nodiscard]] std::vector<std::string> csv_columns(const Model& model);
[[nodiscard]] std::string results_csv(const LoadedProblem& loaded, const Results& results);

}  // namespace hbar::tool
