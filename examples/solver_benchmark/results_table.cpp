#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "results.h"

namespace hbar::solver_benchmark {
namespace {

/// With more matrices than these, only what they say together is shown.
constexpr std::size_t kShownMatrices = 24;

std::string milliseconds(double seconds) {
  const int digits = seconds < 0.1 ? 3 : seconds < 1.0 ? 1 : 0;
  return fmt::format("{:.{}f}", 1e3 * seconds, digits);
}

std::string name_with_choice(const Measurement& m) {
  return m.chosen.empty() ? column_name(m) : fmt::format("{} ({})", column_name(m), m.chosen);
}

std::size_t name_width(const std::vector<Measurement>& measurements) {
  std::size_t width = 6;
  for (const Measurement& measurement : measurements) {
    width = std::max(width, name_with_choice(measurement).size());
  }
  return width;
}

std::string matrix_text(const MatrixResults& matrix, int rhs) {
  std::string text = fmt::format("\n{}: {} rows, {} entries, {}", matrix.label.name, matrix.rows,
                                 matrix.entries, matrix.structure);
  if (matrix.condition) {
    text += fmt::format(", condition {:.1e}", *matrix.condition);
  }
  if (!matrix.failure.empty()) {
    return text + ": " + matrix.failure + '\n';
  }
  const std::size_t width = name_width(matrix.measurements);
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "\n  {:<{}}  analyse  factor refactor   solve trans. {:>8}   fill      MB"
                 " backward forward\n",
                 "ms", width, fmt::format("{} rhs", rhs));
  for (const Measurement& m : matrix.measurements) {
    if (!m.solved()) {
      fmt::format_to(out, "  {:<{}}  {}\n", name_with_choice(m), width, m.failure);
      continue;
    }
    fmt::format_to(out, "  {:<{}} {:>8}{:>8} {:>8}{:>8}{:>7} {:>8}{:>7.2f}{:>8.2f}  {:.1e} {}\n",
                   name_with_choice(m), width, milliseconds(m.analyse), milliseconds(m.factorise),
                   milliseconds(m.refactorise), milliseconds(m.solve),
                   milliseconds(m.solve_transposed), milliseconds(m.solve_many), m.fill,
                   1e-6 * m.bytes, m.backward_error,
                   m.forward_error ? fmt::format("{:.1e}", *m.forward_error) : "");
  }
  return text;
}

std::string profile_text(const BenchmarkResults& results) {
  const CostTable table = cost_table(results);
  std::vector<ProfileLine> lines = performance_profiles(table);
  std::size_t width = 6;
  for (const ProfileLine& line : lines) {
    width = std::max(width, line.solver.size());
  }
  std::stable_sort(lines.begin(), lines.end(), [](const ProfileLine& a, const ProfileLine& b) {
    return (a.mean > 0.0 ? a.mean : 1e300) < (b.mean > 0.0 ? b.mean : 1e300);
  });
  std::string text = fmt::format("\n  {:<{}}  solved  best on  time over best (geometric mean)\n",
                                 "solver", width);
  for (const ProfileLine& line : lines) {
    fmt::format_to(std::back_inserter(text), "  {:<{}} {:>7} {:>8}  {}\n", line.solver, width,
                   fmt::format("{}/{}", line.ratios.size(), line.matrices), line.wins,
                   line.mean > 0.0 ? fmt::format("{:.2f}", line.mean) : "");
  }
  const double automatic = mean_ratio_to_best_other(table, "auto");
  if (automatic > 0.0) {
    fmt::format_to(std::back_inserter(text),
                   "auto takes {:.2f} x the time of the best other (geometric mean)\n", automatic);
  }
  return text;
}

std::string scaling_text(const BenchmarkResults& results, ScalingAxis axis) {
  const std::vector<ScalingLine> lines = scaling_lines(results, axis);
  if (lines.empty()) {
    return "";
  }
  std::string text = fmt::format("\n  exponent of time and of memory in {}\n",
                                 axis == ScalingAxis::kSteps ? "T" : "n");
  for (const ScalingLine& line : lines) {
    fmt::format_to(std::back_inserter(text), "  {:<28} {:<20} {:>6.2f} {:>6.2f}  ({:g} to {:g})\n",
                   line.group, line.solver, line.time_slope(), line.memory_slope(), line.at.front(),
                   line.at.back());
  }
  return text;
}

}  // namespace

std::string results_table(const BenchmarkResults& results) {
  std::string text =
      fmt::format("{} matrices, {} right-hand sides, fastest of {}\n", results.matrices.size(),
                  results.options.rhs, results.options.repeat);
  const bool all = results.matrices.size() <= kShownMatrices;
  for (const MatrixResults& matrix : results.matrices) {
    if (all || !matrix.failure.empty()) {
      text += matrix_text(matrix, results.options.rhs);
    }
  }
  text += profile_text(results);
  text += scaling_text(results, ScalingAxis::kSteps);
  text += scaling_text(results, ScalingAxis::kDof);
  return text;
}

}  // namespace hbar::solver_benchmark
