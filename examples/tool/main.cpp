// The hbar command: what a scene is, its trajectory, the gradient of an objective of it, and the
// proof that the gradient is right. doc/command.md is its manual.

#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <new>

#include "arguments.h"
#include "hbar/scene/atomic_file.h"
#include "inputs.h"
#include "process.h"
#include "results.h"
#include "text_output.h"

namespace hbar::tool {
namespace {

namespace fs = std::filesystem;

/// Refuses, before anything is computed, a result file that could not be written or that is one of
/// the files read.
void check_output(const std::optional<std::string>& output, const LoadedProblem& loaded) {
  if (!output || *output == "-") {
    return;
  }
  const fs::path path(*output);
  std::error_code code;
  for (const fs::path& input : loaded.files) {
    if (fs::equivalent(path, input, code)) {
      throw ToolError(ExitCode::kInputOutput,
                      fmt::format("{}: is an input of this run and stays as it is; name another "
                                  "file for the results",
                                  *output));
    }
  }
  if (fs::is_directory(path, code)) {
    throw ToolError(ExitCode::kInputOutput, *output + ": cannot be written: Is a directory");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!fs::is_directory(folder, code)) {
    throw ToolError(
        ExitCode::kInputOutput,
        fmt::format("{}: cannot be written: there is no folder {}", *output, folder.string()));
  }
}

void check_outputs(const Arguments& arguments, const LoadedProblem& loaded) {
  check_output(arguments.out, loaded);
  check_output(arguments.csv, loaded);
  std::error_code code;
  if (arguments.out && arguments.csv &&
      (fs::weakly_canonical(*arguments.out, code) == fs::weakly_canonical(*arguments.csv, code))) {
    throw ToolError(ExitCode::kUsage, "--out and --csv name the same file");
  }
}

void write_output(const std::string& output, const std::string& text) {
  if (output == "-") {
    write_stdout(text);
  } else {
    scene::write_file_atomically(output, text);
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
Results run(Problem& problem, bool with_gradient) {
  const Rollout rollout = problem.simulator.rollout(problem.inputs);
  const Trajectory& trajectory = rollout.partial();
  Results out;
  out.report = rollout.report();
  out.status = status_word(out.report.status);
  out.message = out.report.message;
  out.values = problem.simulator.values(trajectory);
  if (problem.simulator.model().contact_count() > 0) {
    out.contact = problem.simulator.contact_history(trajectory);
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
    out.gradient = gradient(problem.simulator, trajectory, problem.objective);
  } catch (const NumericalFailure& error) {
    out.status = "gradient_failed";
    out.message = error.what();
  }
  return out;
}

ExitCode simulate(const Arguments& arguments, LoadedProblem& loaded) {
  const Results results = run(loaded.problem, arguments.command == Command::kGradient);
  if (arguments.out) {
    write_output(*arguments.out, results_json(loaded, results));
  }
  if (arguments.csv) {
    write_output(*arguments.csv, results_csv(loaded, results));
  }
  if (!arguments.out && arguments.csv != "-") {
    write_stdout(summarize(loaded, results));
  }
  if (results.status == "converged") {
    return ExitCode::kOk;
  }
  throw ToolError(
      results.status == "interrupted" ? ExitCode::kInterrupted : ExitCode::kSimulationFailed,
      results.message);
}

ExitCode check(const Arguments& arguments, LoadedProblem& loaded) {
  const GradientCheckReport report = check_gradient(loaded.problem);
  if (stop_flag()) {
    throw ToolError(ExitCode::kInterrupted, "gradient check interrupted");
  }
  if (arguments.out) {
    write_output(*arguments.out, check_json(loaded, report));
  } else {
    write_stdout(report.table());
  }
  if (!report.passed()) {
    throw ToolError(ExitCode::kCheckFailed, "the gradient of a class is not confirmed");
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
  switch (arguments.command) {
    case Command::kInfo:
      write_stdout(
          describe(loaded.problem.simulator.model(), loaded.problem.simulator.parameters()));
      return ExitCode::kOk;
    case Command::kSimulate:
    case Command::kGradient:
      return simulate(arguments, loaded);
    case Command::kCheck:
      return check(arguments, loaded);
  }
  return ExitCode::kUsage;
}

ExitCode run_line(int argc, const char* const* argv) {
  const std::variant<Arguments, std::string> parsed = parse_arguments(argc, argv);
  if (const auto* text = std::get_if<std::string>(&parsed)) {
    write_stdout(*text);
    return ExitCode::kOk;
  }
  return run_command(std::get<Arguments>(parsed));
}

/// What is thrown, as an exit code and a line on standard error.
ExitCode guarded(int argc, const char* const* argv) {
  try {
    return run_line(argc, argv);
  } catch (const ToolError& error) {
    if (*error.what() != '\0') {
      write_message(error.what());
    }
    return error.code();
  } catch (const IoError& error) {
    write_message(error.what());
    return ExitCode::kInputOutput;
  } catch (const InvalidInput& error) {
    write_message(error.what());
    return ExitCode::kBadScene;
  } catch (const NumericalFailure& error) {
    write_message(error.what());
    return stop_flag() ? ExitCode::kInterrupted : ExitCode::kSimulationFailed;
  } catch (const std::bad_alloc&) {
    write_message("out of memory; take fewer steps or parameters");
    return ExitCode::kOutOfMemory;
  } catch (const std::exception& error) {
    write_message(error.what());
    return ExitCode::kSimulationFailed;
  }
}

}  // namespace
}  // namespace hbar::tool

int main(int argc, char** argv) {
  hbar::tool::prepare_process();
  return static_cast<int>(hbar::tool::guarded(argc, argv));
}
