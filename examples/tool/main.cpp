// The hbar command: describes a scene, simulates it, computes the gradient of an objective and
// verifies it, and compares linear solvers on such systems. doc/command.md is its manual.

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "arguments.h"
#include "examples/common/process.h"
#include "gradient_solver.h"
#include "hbar/core/files/numbers.h"
#include "inputs.h"
#include "outputs.h"
#include "results.h"
#ifdef HBAR_HAVE_SUITE
#include "solver_commands.h"
#endif
#include "text_output.h"

namespace hbar::tool {

using example::ExitCode;
using example::print;
using example::ProgramError;
using example::stop_flag;
using example::StopsGently;
using example::write_message;
namespace {

void check_outputs(const Arguments& arguments, const LoadedProblem& loaded) {
  check_output(arguments.out, loaded.files);
  check_output(arguments.csv, loaded.files);
  check_distinct("--out", arguments.out, "--csv", arguments.csv);
  if (arguments.csv) {
    std::vector<std::string> columns = csv_columns(loaded.problem.horizon.model());
    std::sort(columns.begin(), columns.end());
    const auto twice = std::adjacent_find(columns.begin(), columns.end());
    if (twice != columns.end()) {
      throw ProgramError(
          ExitCode::kBadScene,
          fmt::format("--csv: two columns would be called \"{}\"; rename a joint, an "
                      "end effector or a sensor",
                      scene::quotable(*twice)));
    }
  }
}

std::string status_word(RolloutStatus status) {
  switch (status) {
    case RolloutStatus::kConverged:
      return "converged";
    case RolloutStatus::kInterrupted:
      return "interrupted";
    case RolloutStatus::kStepFailed:
      return "step_failed";
  }
  return "";
}

/// Simulates, and differentiates if asked and nothing came between.
Results run(const LoadedProblem& loaded, bool with_gradient) {
  const Problem& problem = loaded.problem;
  const Rollout rollout = simulate(problem.horizon, problem.inputs);
  const Trajectory& trajectory = rollout.partial();
  Results out;
  out.report = rollout.report();
  out.status = status_word(out.report.status);
  out.message = out.report.message;
  out.values = read_values(problem.horizon, trajectory);
  if (problem.horizon.model().contact_count() > 0) {
    out.contact = contact_history(problem.horizon, trajectory);
  }
  for (int k = 0; k < trajectory.step_count(); ++k) {
    out.newton.push_back(trajectory.newton_iterations(k));
  }
  if (!rollout.converged()) {
    return out;
  }
  out.value = problem.objective.value(out.values);
  if (!with_gradient) {
    return out;
  }
  if (stop_flag()) {
    out.status = "interrupted";
    out.message = "interrupted before the gradient";
    return out;
  }
  try {
    out.gradient = gradient_of(loaded, trajectory);
  } catch (const Interrupted& error) {
    out.status = "interrupted";
    out.message = error.what();
  } catch (const NumericalFailure& error) {
    out.status = "gradient_failed";
    out.message = error.what();
  }
  return out;
}

ExitCode simulate(const Arguments& arguments, const LoadedProblem& loaded) {
  const Results results = run(loaded, arguments.command == Command::kGradient);
  if (arguments.out) {
    write_output(*arguments.out, results_json(loaded, results));
  }
  if (arguments.csv) {
    write_output(*arguments.csv, results_csv(loaded, results));
  }
  if (!arguments.out && arguments.csv != "-") {
    print(summarize(loaded, results));
  }
  if (results.status == "converged") {
    return ExitCode::kOk;
  }
  throw ProgramError(
      results.status == "interrupted" ? ExitCode::kInterrupted : ExitCode::kSimulationFailed,
      results.message);
}

ExitCode check(const Arguments& arguments, const LoadedProblem& loaded) {
  const GradientCheckReport report = check_gradient(loaded.problem);
  if (stop_flag()) {
    throw ProgramError(ExitCode::kInterrupted, "gradient check interrupted");
  }
  if (arguments.out) {
    write_output(*arguments.out, check_json(loaded, report));
  } else {
    print(report.table());
  }
  if (!report.passed()) {
    throw ProgramError(ExitCode::kCheckFailed, "the gradient of a class is not confirmed");
  }
  if (!report.unresolved().empty()) {
    write_message(fmt::format(
        "no difference could be taken on one smooth piece: {}: only the dot product confirms these",
        fmt::join(report.unresolved(), ", ")));
  }
  return ExitCode::kOk;
}

ExitCode run_command(const Arguments& given) {
  Arguments arguments = given;
  arguments.load.stop = &stop_flag();
  LoadedProblem loaded = load(arguments);
  for (const std::string& notice : loaded.notices) {
    write_message(notice);
  }
  check_outputs(arguments, loaded);
  const StopsGently gently;
  switch (arguments.command) {
    case Command::kInfo:
      print(describe(loaded.problem.horizon.model(), loaded.problem.horizon.parameters()));
      return ExitCode::kOk;
    case Command::kSimulate:
    case Command::kGradient:
      return simulate(arguments, loaded);
    case Command::kCheck:
      return check(arguments, loaded);
    case Command::kSolvers:
    case Command::kCorpus:
      break;  // they have arguments of their own
  }
  return ExitCode::kUsage;
}

#ifdef HBAR_HAVE_SUITE
ExitCode run_command(const SolverArguments& arguments) { return run_solvers(arguments); }
ExitCode run_command(const CorpusArguments& arguments) { return run_corpus(arguments); }
#else
[[noreturn]] void say_no_suite() {
  throw ProgramError(ExitCode::kUsage,
                     "this build has no hbar::suite, whose solvers are measured; configure with "
                     "-DHBAR_WITH_SUITE=ON");
}
ExitCode run_command(const SolverArguments& /*arguments*/) { say_no_suite(); }
ExitCode run_command(const CorpusArguments& /*arguments*/) { say_no_suite(); }
#endif

/// Help or version.
ExitCode run_command(const std::string& text) {
  print(text);
  return ExitCode::kOk;
}

ExitCode run_line(int argc, const char* const* argv) {
  return std::visit([](const auto& parsed) { return run_command(parsed); },
                    parse_arguments(argc, argv));
}

}  // namespace
}  // namespace hbar::tool

int main(int argc, char** argv) {
  hbar::example::prepare_process("hbar");
  return hbar::example::guarded([&] { return hbar::tool::run_line(argc, argv); });
}
