#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results.h"

namespace hbar::solver_benchmark {

/// A figure: gnuplot reads its data and its script and draws it.
struct Plot {
  std::string name;    ///< of NAME.svg, NAME.dat and NAME.gp
  std::string data;    ///< columns of numbers; blocks are separated by two empty lines
  std::string script;  ///< that draws NAME.svg from NAME.dat
};

/// Time and memory against T and against n for every group of scaling_lines, with the slopes in
/// the legend, and the performance profile. A plot that has nothing to show is not there.
[[nodiscard]] std::vector<Plot> benchmark_plots(const BenchmarkResults& results);

/// The pattern of a matrix, of its factors in the given order and of those in minimum-degree order,
/// side by side. Factors are those of the symmetrised pattern (symbolic_factor); of a large matrix
/// its leading block is shown.
[[nodiscard]] Plot spy_plot(const BenchmarkMatrix& matrix);

/// Writes data and script of each plot into a folder and has gnuplot draw it there.
///
/// @param folder  exists
/// @throws IoError if a file cannot be written, or as run_gnuplot
void write_plots(const std::vector<Plot>& plots, const std::filesystem::path& folder);

}  // namespace hbar::solver_benchmark
