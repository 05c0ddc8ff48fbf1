#include <fmt/format.h>

#include <iterator>

#include "results.h"

namespace hbar::solver_benchmark {
namespace {

/// A text as a cell: in quotes where it needs them.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) {
    return text;
  }
  std::string out = "\"";
  for (const char c : text) {
    out += c == '"' ? "\"\"" : std::string(1, c);
  }
  return out + '"';
}

std::string cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

}  // namespace

std::string results_csv(const BenchmarkResults& results) {
  std::string text =
      "matrix,source,family,system,integrator,dof,steps,h,structure,rows,entries,condition,solver,"
      "ordering,chosen,failure,analyse,factorise,refactorise,solve,solve_transposed,solve_many,"
      "factor_entries,fill,bytes,flops,backward_error,componentwise_error,transposed_error,"
      "forward_error\n";
  const auto out = std::back_inserter(text);
  for (const MatrixResults& matrix : results.matrices) {
    const MatrixLabel& label = matrix.label;
    for (const Measurement& m : matrix.measurements) {
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", cell(label.name),
                     cell(label.source), label.family, label.system, label.integrator, label.dof,
                     label.steps, label.h, matrix.structure, matrix.rows, matrix.entries,
                     cell(matrix.condition), m.solver, m.ordering, m.chosen, cell(m.failure));
      if (m.solved()) {
        fmt::format_to(out, ",{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", m.analyse, m.factorise,
                       m.refactorise, m.solve, m.solve_transposed, m.solve_many, m.entries, m.fill,
                       m.bytes, cell(m.flops), m.backward_error, m.componentwise_error,
                       m.transposed_error, cell(m.forward_error));
      } else {
        text += std::string(14, ',') + '\n';
      }
    }
  }
  return text;
}

}  // namespace hbar::solver_benchmark
