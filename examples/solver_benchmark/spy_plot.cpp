#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>

#include "elimination.h"
#include "gnuplot.h"
#include "plots.h"

namespace hbar::solver_benchmark {
namespace {

/// Of larger matrices so many rows are shown: beyond, single entries can no longer be seen.
constexpr int kShownRows = 160;

void add_point(std::string& data, Eigen::Index row, Eigen::Index column) {
  fmt::format_to(std::back_inserter(data), "{} {}\n", column + 1, row + 1);
}

/// The entries of A as one block of data, then what elimination fills in as another.
///
/// @returns  entries of L and its transpose, the diagonal once
std::size_t add_factors(const solvers::SparseMatrix& A, std::string& data) {
  std::set<std::pair<int, int>> own;
  for (int j = 0; j < A.cols(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      own.emplace(static_cast<int>(entry.row()), j);
      add_point(data, entry.row(), j);
    }
  }
  data += "\n\n";
  std::size_t count = 0;
  const std::vector<std::vector<int>> L = symbolic_factor(A);
  for (int j = 0; j < A.cols(); ++j) {
    for (const int i : L[static_cast<std::size_t>(j)]) {
      count += i == j ? 1 : 2;
      for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)}) {
        if (!own.contains({row, column})) {
          add_point(data, row, column);
        }
      }
    }
  }
  data += data.ends_with("\n\n\n") ? "0 0\n\n\n" : "\n\n";  // gnuplot counts no empty block
  return count;
}

}  // namespace

Plot spy_plot(const BenchmarkMatrix& matrix) {
  const auto rows = std::min<Eigen::Index>(matrix.A.rows(), kShownRows);
  const solvers::SparseMatrix A = matrix.A.topLeftCorner(rows, rows);
  Plot plot{.name = file_name("spy_" + matrix.label.name), .data = {}, .script = {}};
  const std::size_t given = add_factors(A, plot.data);
  const std::size_t minimum = add_factors(reordered(A, minimum_degree_order(A)), plot.data);

  plot.script = fmt::format(
      "set terminal svg size 1200,460 noenhanced font 'sans,12' background 'white'\n"
      "set output {}\nset multiplot layout 1,3 title {}\n"
      "set size square\nset xrange [0:{}]\nset yrange [{}:0]\nunset key\n"
      "entries = 'with points pt 7 ps 0.15 lc rgb \"#20407f\"'\n"
      "fill = 'with points pt 7 ps 0.15 lc rgb \"#d06020\"'\n",
      quoted(plot.name + ".svg"),
      quoted(rows < matrix.A.rows() ? fmt::format("{}: the first {} of {} rows", matrix.label.name,
                                                  rows, matrix.A.rows())
                                    : fmt::format("{}: {} rows", matrix.label.name, rows)),
      rows + 1, rows + 1);
  const std::string file = quoted(plot.name + ".dat");
  plot.script += fmt::format("set title {}\nplot {} index 0 @entries\n",
                             quoted(fmt::format("{} entries", A.nonZeros())), file);
  plot.script += fmt::format("set title {}\nplot {} index 1 @fill, {} index 0 @entries\n",
                             quoted(fmt::format("factors: {} entries", given)), file, file);
  plot.script +=
      fmt::format("set title {}\nplot {} index 3 @fill, {} index 2 @entries\n",
                  quoted(fmt::format("minimum degree: {} entries", minimum)), file, file);
  plot.script += "unset multiplot\n";
  return plot;
}

}  // namespace hbar::solver_benchmark
