#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iterator>

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

}  // namespace hbar::example
