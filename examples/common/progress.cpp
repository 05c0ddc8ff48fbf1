#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iterator>
#include <system_error>

#include "hbar/core/error.h"
#include "process.h"

namespace hbar::example {

std::string progress_line(const solvers::IterationInfo& info) {
  return fmt::format("{:>4}{} {:>12.6f} {:>12.3e} {:>12.3e} {:>10.2e} {:>8.2f} s", info.iteration,
                     info.restoring ? 'r' : ' ', info.objective, info.primal_infeasibility,
                     info.dual_infeasibility, info.step_norm, info.elapsed);
}

std::string progress_heading() {
  return fmt::format("{:>4}  {:>12} {:>12} {:>12} {:>10} {:>10}", "iter", "objective", "violation",
                     "optimality", "step", "time");
}

Progress::Progress() : terminal_(::isatty(STDOUT_FILENO) == 1) {}

void Progress::show(const solvers::IterationInfo& info) {
  iterations_.push_back(info);
  const std::string line = progress_line(info);
  if (!terminal_) {
    print(line + '\n');
  } else {
    print("\r\033[K" + line + (info.iteration % 10 == 0 ? "\n" : ""));
  }
}

void Progress::end() const {
  if (terminal_) {
    print("\n");
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) {
    throw IoError(concat(folder.string(), ": the folder cannot be made: ", code.message()));
  }
}

std::string iterations_csv(const std::vector<solvers::IterationInfo>& iterations) {
  std::string text =
      "iteration,objective,primal_infeasibility,dual_infeasibility,mu,step_norm,alpha_primal,"
      "trials,restoring,seconds\n";
  for (const solvers::IterationInfo& info : iterations) {
    fmt::format_to(std::back_inserter(text),
                   "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{:d},{:.3f}\n",
                   info.iteration, info.objective, info.primal_infeasibility,
                   info.dual_infeasibility, info.mu, info.step_norm, info.alpha_primal,
                   info.line_search_trials, info.restoring, info.elapsed);
  }
  return text;
}

std::string trajectory_csv(const Model& model, const TrajectoryValues& values) {
  std::string text = "time";
  const auto out = std::back_inserter(text);
  for (const char* prefix : {"", "rate."}) {
    for (int i = 0; i < model.dof(); ++i) {
      fmt::format_to(out, ",{}{}", prefix, model.coordinate_name(i));
    }
  }
  for (const EndEffector& point : model.end_effectors()) {
    fmt::format_to(out, ",{0}.x,{0}.y,{0}.z", point.name);
  }
  for (int i = 0; i < model.control_count(); ++i) {
    fmt::format_to(out, ",control.{}", model.control_name(i));
  }
  for (Eigen::Index k = 0; k < values.q.cols(); ++k) {
    fmt::format_to(out, "\n{:.17g}", static_cast<double>(k) * values.h);
    for (const Eigen::MatrixXd* field : {&values.q, &values.qdot, &values.v}) {
      for (const double number : field->col(k)) {
        fmt::format_to(out, ",{:.17g}", number);
      }
    }
    for (Eigen::Index i = 0; i < values.u.rows(); ++i) {
      fmt::format_to(out, ",{}", k == 0 ? "" : fmt::format("{:.17g}", values.u(i, k - 1)));
    }
  }
  return text + '\n';
}

}  // namespace hbar::example
