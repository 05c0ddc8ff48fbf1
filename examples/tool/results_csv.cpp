#include <fmt/format.h>

#include "hbar/core/files/csv.h"
#include "labels.h"
#include "results.h"

namespace hbar::tool {

std::vector<std::string> csv_columns(const Model& model) {
  std::vector<std::string> columns = {"time"};
  for (const std::string& name : coordinate_names(model)) {
    columns.push_back("q." + name);
  }
  for (const std::string& name : coordinate_names(model)) {
    columns.push_back("qdot." + name);
  }
  for (const std::vector<std::string>& names : {variable_names(model), tactile_names(model)}) {
    columns.insert(columns.end(), names.begin(), names.end());
  }
  return columns;
}

std::string results_csv(const LoadedProblem& loaded, const Results& results) {
  const Model& model = loaded.problem.horizon.model();
  const TrajectoryValues& values = results.values;
  std::string text;
  for (const std::string& column : csv_columns(model)) {
    text += (text.empty() ? "" : ",") + scene::csv_cell(column);
  }
  text += '\n';
  constexpr Eigen::Index kDigits = 24;  // the longest number with its separator
  const Eigen::Index columns =
      1 + 2 * values.q.rows() + values.v().rows() + values.tactile().rows();
  text.reserve(text.size() + static_cast<std::size_t>(kDigits * columns * values.q.cols()));
  for (Eigen::Index k = 0; k < values.q.cols(); ++k) {
    const auto end = std::back_inserter(text);
    fmt::format_to(end, "{:.17g}", static_cast<double>(k) * values.h);
    const auto write = [&](const Eigen::Ref<const Eigen::VectorXd>& numbers) {
      for (const double entry : numbers) {
        fmt::format_to(end, ",{:.17g}", entry);
      }
    };
    write(values.q.col(k));
    write(values.qdot.col(k));
    write(values.v().col(k));
    write(values.tactile().col(k));
    text += '\n';
  }
  return text;
}

}  // namespace hbar::tool
