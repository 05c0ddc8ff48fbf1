// Co-design of a four-joint finger: the sizes of its phalanges and the torques of its motors, such
// that the tip visits four targets in 3 s with the least effort.
//
//   cmake --build build/release --target finger_reach
//   build/release/examples/finger_reach/finger_reach
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv and
// iterations.csv into results/finger_reach. doc/finger_reach.md tells what is solved and found.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "examples/common/process.h"
#include "examples/common/progress.h"
#include "hbar/scene/atomic_file.h"
#include "hbar/study/trajectory_csv.h"
#include "report.h"

namespace hbar::finger_reach {
namespace {

using example::ExitCode;
using example::print;

struct Arguments {
  std::filesystem::path out = "results/finger_reach";
  std::filesystem::path scene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
  int max_iterations = 200;
  int steps = 600;
};

ExitCode run(const Arguments& arguments) {
  // 1. The problem.
  example::make_folder(arguments.out);
  Reach reach = make_reach(arguments.scene, arguments.steps);
  Transcription& problem = *reach.problem;
  Outcome outcome;
  outcome.start = problem.variables().start;
  outcome.start_objective = problem.objective(outcome.start);
  print(fmt::format("finger_reach: {} variables, {} constraints, {} steps of {:g} s\n{}\n",
                    outcome.start.size(), problem.constraint_limits().lower.size(), arguments.steps,
                    kDuration / arguments.steps, example::progress_heading()));

  // 2. Ipopt.
  example::Progress progress;
  solvers::IpoptOptions options = ipopt_options(arguments.max_iterations);
  options.stop = &example::stop_flag();
  options.on_iteration = [&](const solvers::IterationInfo& info) {
    progress.show(info);
    return true;
  };
  outcome.result = solvers::solve_with_ipopt(problem, options);
  progress.end();

  // 3. What came out, converged or not.
  outcome.iterations = progress.iterations();
  outcome.times = problem.times();
  outcome.values = problem.trajectory_values(outcome.result.x);
  scene::write_file_atomically(arguments.out / "result.json", result_json(reach, outcome));
  scene::write_file_atomically(
      arguments.out / "trajectory.csv",
      study::trajectory_csv(study::trajectory_names(problem.problem().simulator), outcome.values));
  scene::write_file_atomically(arguments.out / "iterations.csv",
                               example::iterations_csv(outcome.iterations));
  print(summary(reach, outcome));
  print(fmt::format("written:     {}/result.json, trajectory.csv, iterations.csv\n",
                    arguments.out.string()));
  if (outcome.result.status == solvers::IpoptStatus::kInterrupted) {
    return ExitCode::kInterrupted;
  }
  return outcome.result.converged() ? ExitCode::kOk : ExitCode::kNotConverged;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Co-design of a finger that reaches four targets with the least effort.",
               "finger_reach");
  app.add_option("--out", arguments.out, "Folder for the results.")->capture_default_str();
  app.add_option("--scene", arguments.scene, "The finger.");
  app.add_option("--max-iterations", arguments.max_iterations, "Of Ipopt.")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--steps", arguments.steps, "Of the 3 s, a multiple of 60.")
      ->check(CLI::Range(60, 60000))
      ->check([](const std::string& text) {
        return std::stol(text) % 60 == 0 ? "" : "must be a multiple of 60";
      })
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  return run(arguments);
}

}  // namespace
}  // namespace hbar::finger_reach

int main(int argc, char** argv) {
  hbar::example::prepare_process();
  return hbar::example::guarded("finger_reach",
                                [&] { return hbar::finger_reach::run_line(argc, argv); });
}
