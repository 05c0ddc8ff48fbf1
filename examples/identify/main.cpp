// What moves how, and why: masses, damping and friction of a rig from its recorded motion.
//
//   cmake --build build/release --target identify
//   build/release/examples/identify/identify
//
// simulates a motion, adds noise, writes it to results/identify/measured.csv, reads it back and
// fits the unknowns from a wrong start; doc/identify.md tells what is found. --data FILE fits a
// recording of your own.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <utility>

#include "examples/common/optimise.h"
#include "examples/common/progress.h"
#include "hbar/core/files/text_file.h"
#include "report.h"

namespace hbar::identify {
namespace {

using example::ExitCode;
using example::print;

struct Arguments {
  example::OptimiseArguments optimise;
  RigOptions rig;
  Sigmas sigmas = default_sigmas();
  std::filesystem::path data;
  unsigned seed = 1;
  int repeat = 0;
  bool compare = false;
  bool no_sliding = false;
};

ExitCode repeat(const Rig& rig, const Arguments& arguments) {
  const study::JobReport report =
      repeat_fits(rig, arguments.sigmas,
                  {.name = arguments.rig.sliding ? "identify" : "identify without sliding",
                   .seed = arguments.seed,
                   .count = arguments.repeat,
                   .table = arguments.optimise.out / "repeat.csv",
                   .stop = &example::stop_flag()});
  for (const std::optional<study::JobResult>& result : report.results) {
    if (result && result->failed) {
      print(fmt::format("a fit failed: {}\n", result->message));
      break;
    }
  }
  if (example::stop_flag()) {
    return ExitCode::kInterrupted;
  }
  print(fmt::format("\n{}written: {}/repeat.csv\n",
                    coverage_table(coverage(report, rig.nominal), rig.map->variables().names),
                    arguments.optimise.out.string()));
  return ExitCode::kOk;
}

ExitCode run(Arguments arguments) {
  const example::StopsGently gently;
  example::expect_results(arguments.optimise.out,
                          {"solution.csv", "iterations.csv", "trajectory.csv", "repeat.csv"},
                          {arguments.rig.scene, arguments.data});
  const bool simulated = arguments.data.empty();
  arguments.rig.sliding = !arguments.no_sliding;
  arguments.rig.wrong_start = simulated;
  if (arguments.optimise.formulation == name_of(Formulation::kMultipleShooting)) {
    arguments.rig.segments = arguments.optimise.segments;
  }
  const Rig rig = make_rig(arguments.rig);
  if (simulated) {
    arguments.data = arguments.optimise.out / "measured.csv";
    std::mt19937_64 random(arguments.seed);
    example::write_result(arguments.data, recorded_csv(rig, arguments.sigmas, random));
  }
  const Recording recording = read_recording(
      rig, arguments.sigmas, scene::read_text_file(arguments.data), arguments.data.string());
  print(fmt::format("{}: {} data, {} unknowns\n", arguments.data.string(),
                    recording.data.data.size(), rig.map->variables().size()));
  const auto program =
      misfit_program(rig, recording, example::transcription_options(arguments.optimise));
  const example::Optimised found =
      example::optimise(*program, arguments.optimise, fit_options(recording));
  const study::Information known = information_at(*program, recording, found.result.x);
  print('\n' +
        estimate_table(known, rig.map->variables(), simulated ? rig.nominal : Eigen::VectorXd()));
  if (arguments.compare && known.complete()) {
    print('\n' + ways_table(every_way(rig, recording), known.standard_deviations));
  }
  if (arguments.repeat > 0) {
    return repeat(rig, arguments);
  }
  return found.code;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  arguments.rig.scene = HBAR_SOURCE_DIR "/examples/scenes/identify.xml";
  arguments.optimise.out = "results/identify";
  arguments.optimise.formulation = "shooting";
  arguments.optimise.hessian = "gauss-newton";
  arguments.optimise.max_iterations = 200;
  std::vector<std::pair<std::string, double>> sigmas;
  CLI::App app("Masses, damping and friction of a rig from its recorded motion.", "identify");
  example::add_options(app, arguments.optimise);
  app.add_option("--scene", arguments.rig.scene, "The rig.");
  app.add_option("--steps", arguments.rig.steps, "Of 10 ms.")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  CLI::Option* data =
      app.add_option("--data", arguments.data,
                     "A recording to fit, instead of a simulated one: time and columns.");
  app.add_option("--sigma", sigmas, "NAME NUMBER: standard deviation of a column.");
  app.add_option("--unknown", arguments.rig.unknowns, "Names of parameters to be found.");
  app.add_option("--seed", arguments.seed, "Of the simulated noise.")->capture_default_str();
  app.add_flag("--no-sliding", arguments.no_sliding,
               "The shoe is never pressed onto the table: what can be known without friction?");
  app.add_flag("--compare", arguments.compare, "Fit by every optimiser and Hessian.");
  app.add_option("--repeat", arguments.repeat,
                 "Fit so many recordings with errors of their own, on all cores: do the intervals "
                 "hold the truth?")
      ->check(CLI::Range(2, 1000000))
      ->excludes(data);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  for (const auto& [name, sigma] : sigmas) {
    arguments.sigmas[name] = sigma;
  }
  return run(std::move(arguments));
}

}  // namespace
}  // namespace hbar::identify

int main(int argc, char** argv) {
  hbar::example::prepare_process("identify");
  return hbar::example::guarded([&] { return hbar::identify::run_line(argc, argv); });
}
