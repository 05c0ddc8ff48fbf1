#pragma once

#include <functional>

#include "results.h"

namespace hbar::solver_benchmark {

/// What is benchmarked: matrices × solvers × orderings.
struct BenchmarkPlan {
  std::vector<Case> cases;
  std::vector<std::filesystem::path> files;  ///< Matrix Market, after the cases
  std::string structure;  ///< of all of `files`; empty: as read_benchmark_matrix finds it
  /// Names of available_solvers() and "auto"; empty: "auto" and, for each matrix, all that claim
  /// it.
  std::vector<std::string> solvers;
  std::vector<solvers::Ordering> orderings = {solvers::Ordering::kDefault};
  MeasureOptions options;
  const std::atomic<bool>* stop = nullptr;  ///< looked at between measurements; may be null
  /// Called before each matrix and each measurement, if it is there: how many of how many matrices
  /// are done, and what comes next.
  std::function<void(std::size_t, std::size_t, const std::string&)> on_progress;
  /// Called with every matrix, if it is there.
  std::function<void(const BenchmarkMatrix&)> on_matrix;
  /// Called after every measurement with all so far, if it is there.
  std::function<void(const BenchmarkResults&)> on_measured;
};

/// @throws InvalidInput for a solver that is not known, or if none of the solvers offers any of the
///         orderings
void check_plan(const BenchmarkPlan& plan);

/// Runs the benchmark. Failures of a matrix or a solver are recorded in the results; the rest
/// continues. Orderings that a solver does not offer are skipped.
///
/// @throws as check_plan
[[nodiscard]] BenchmarkResults run_benchmark(const BenchmarkPlan& plan);

}  // namespace hbar::solver_benchmark
