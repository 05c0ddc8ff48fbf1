#include <fmt/format.h>

#include "labels.h"
#include "results.h"

namespace hbar::tool {

std::string results_csv(const LoadedProblem& loaded, const Results& results) {
  const Model& model = loaded.problem.horizon.model();
  const TrajectoryValues& values = results.values;
  std::string text = "time";
  for (const std::string& name : coordinate_names(model)) {
    text += ",q." + name;
  }
  for (const std::string& name : coordinate_names(model)) {
    text += ",qdot." + name;
  }
  for (const std::string& name : variable_names(model)) {
    text += "," + name;
  }
  for (const std::string& name : tactile_names(model)) {
    text += "," + name;
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
