// Co-design of a four-joint finger: the sizes of its phalanges and the torques of its motors, such
// that the tip visits four targets in 3 s with the least effort.
//
//   cmake --build build/release --target finger_reach
//   build/release/examples/finger_reach/finger_reach
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, finger.svg (a picture
// of the optimum), solution.csv, trajectory.csv and iterations.csv into results/finger_reach.
// doc/finger_reach.md tells what is solved and found.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

#include "examples/common/progress.h"
#include "picture.h"
#include "report.h"
#include "studies.h"

namespace hbar::finger_reach {
namespace {

using example::ExitCode;
using example::print;

struct Arguments {
  example::OptimiseArguments optimise;
  std::filesystem::path scene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
  int steps = 600;
  bool compare = false;
  bool pareto = false;
  bool sensitivity = false;
};

const std::filesystem::path& folder(const Arguments& arguments) { return arguments.optimise.out; }

ExitCode compare(const Arguments& arguments) {
  const std::vector<Way> ways =
      solve_every_way(arguments.scene, arguments.steps, arguments.optimise);
  print(ways_table(ways));
  return example::stop_flag() ? ExitCode::kInterrupted : ExitCode::kOk;
}

ExitCode pareto(const Arguments& arguments) {
  const auto save = [&arguments](const std::vector<FrontPoint>& front) {
    example::write_result(folder(arguments) / "pareto.csv", front_csv(front));
  };
  const std::vector<FrontPoint> front =
      front_of_mass(arguments.scene, arguments.steps, arguments.optimise,
                    {1.0, 0.8, 0.6, 0.4, 0.3, 0.2, 0.15, 0.1, 0.05}, save);
  print(fmt::format("{}written: {}/pareto.csv\n", front_table(front), folder(arguments).string()));
  return example::stop_flag() ? ExitCode::kInterrupted : ExitCode::kOk;
}

ExitCode run(const Arguments& arguments) {
  const example::StopsGently gently;
  example::expect_results(folder(arguments), {"result.json", "finger.svg", "pareto.csv"},
                          {arguments.scene});
  if (arguments.compare) {
    return compare(arguments);
  }
  if (arguments.pareto) {
    return pareto(arguments);
  }
  // 1. The problem.
  ReachOptions options{.steps = arguments.steps,
                       .transcription = example::transcription_options(arguments.optimise),
                       .payload = {}};
  if (arguments.sensitivity) {
    options.payload = 0.0;
  }
  if (options.transcription.formulation == Formulation::kMultipleShooting) {
    options.segments = arguments.optimise.segments;
  }
  const Reach reach = make_reach(arguments.scene, options);
  Transcription& program = *reach.problem;
  Outcome outcome;
  outcome.start = program.variables().start;
  outcome.start_objective = program.objective(outcome.start);
  print(fmt::format("finger_reach: {} steps of {:g} s\n", arguments.steps,
                    kDuration / arguments.steps));

  // 2. Ipopt, and its files.
  solvers::IpoptOptions ipopt = ipopt_options();
  if (arguments.sensitivity) {  // whose equations hold at an optimum alone
    ipopt.tolerance = 1e-9;
    ipopt.acceptable_tolerance = 1e-9;
  }
  outcome.optimised = example::optimise(program, arguments.optimise, ipopt);

  // 3. What came out, converged or not.
  const solvers::IpoptResult& result = outcome.optimised.result;
  outcome.values = program.trajectory_values(result.x);
  example::write_result(folder(arguments) / "result.json", result_json(reach, outcome));
  example::write_result(folder(arguments) / "finger.svg", picture_svg(reach, outcome));
  print('\n' + summary(reach, outcome));
  print(fmt::format("written:     {0}/result.json, {0}/finger.svg\n", folder(arguments).string()));
  if (arguments.sensitivity && result.converged()) {
    print(sensitivity_table(reach, result));
  }
  return outcome.optimised.code;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  arguments.optimise.out = "results/finger_reach";
  arguments.optimise.formulation = "shooting";
  arguments.optimise.hessian = "limited-memory";
  arguments.optimise.max_iterations = 200;
  arguments.optimise.segments = 10;
  CLI::App app("Co-design of a finger that reaches four targets with the least effort.",
               "finger_reach");
  example::add_options(app, arguments.optimise);
  app.add_option("--scene", arguments.scene, "The finger.");
  app.add_option("--steps", arguments.steps, "Of the 3 s, a multiple of 60; or 12, 24, 36, 48.")
      ->check([](const std::string& text) {
        const long steps = std::strtol(text.c_str(), nullptr, 10);
        return steps >= 12 && steps <= 60000 && steps % (steps < 60 ? 12 : 60) == 0
                   ? ""
                   : "must be a multiple of 60 up to 60000, or 12, 24, 36 or 48";
      })
      ->capture_default_str();
  CLI::Option* compare = app.add_flag("--compare", arguments.compare,
                                      "Solve by every formulation with every Hessian.");
  app.add_flag("--pareto", arguments.pareto, "The front of effort and mass.")->excludes(compare);
  app.add_flag("--sensitivity", arguments.sensitivity,
               "How the optimum answers the tip's mass and the mass limit.");
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
  hbar::example::prepare_process("finger_reach");
  return hbar::example::guarded([&] { return hbar::finger_reach::run_line(argc, argv); });
}
