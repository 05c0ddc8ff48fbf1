#pragma once

#include <string>
#include <vector>

#include "measure.h"
#include "performance_profile.h"
#include "scaling.h"

namespace hbar::solver_benchmark {

/// What was measured on one matrix.
struct MatrixResults {
  MatrixLabel label;
  std::string structure;  ///< name of solvers::Structure
  int rows = 0;
  double entries = 0.0;             ///< stored, zeros among them included
  std::optional<double> condition;  ///< estimate of ‖A‖₁ ‖A⁻¹‖₁
  std::string failure;              ///< why there was nothing to measure; else empty
  std::vector<Measurement> measurements;
};

/// The measurements of a benchmark, as far as it got.
struct BenchmarkResults {
  MeasureOptions options;
  bool interrupted = false;
  std::vector<MatrixResults> matrices;
};

/// "klu", or "cholmod_llt+amd" where the ordering is not the solver's own.
[[nodiscard]] std::string column_name(const Measurement& measurement);

/// Measurement::total() of every solver and ordering on every matrix.
[[nodiscard]] CostTable cost_table(const BenchmarkResults& results);

/// How time and memory grow along an axis, a line for every solver on every group of matrices that
/// differ in nothing else.
[[nodiscard]] std::vector<ScalingLine> scaling_lines(const BenchmarkResults& results,
                                                     ScalingAxis axis);

/// Readable output: a table per matrix (if there are few), then a summary.
[[nodiscard]] std::string results_table(const BenchmarkResults& results);

/// A row for every solver on every matrix; what is not known is empty.
[[nodiscard]] std::string results_csv(const BenchmarkResults& results);

/// Everything; what is not known is null.
[[nodiscard]] std::string results_json(const BenchmarkResults& results);

}  // namespace hbar::solver_benchmark
