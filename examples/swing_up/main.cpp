// A cart swings two rods up, from hanging to standing, with the least effort.
//
//   cmake --build build/release --target swing_up
//   build/release/examples/swing_up/swing_up
//
// prints a line per iteration of Ipopt and what was found in words, and writes solution.csv,
// trajectory.csv and iterations.csv into results/swing_up. doc/swing_up.md tells what is solved and
// found.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "examples/common/progress.h"
#include "measure.h"

namespace hbar::swing_up {
namespace {

using example::ExitCode;
using example::print;

struct Arguments {
  example::OptimiseArguments optimise;
  std::filesystem::path scene = HBAR_SOURCE_DIR "/examples/scenes/swing_up.xml";
  int steps = 200;
  bool compare = false;
  bool scaling = false;
};

ExitCode run(const Arguments& arguments) {
  const example::StopsGently gently;
  if (arguments.scaling) {
    print(scaling_table(measure_scaling(arguments.scene, {100, 1000, 10000})));
    return example::stop_flag() ? ExitCode::kInterrupted : ExitCode::kOk;
  }
  const SwingUp swing_up = make_swing_up(arguments.scene, arguments.steps);
  if (arguments.compare) {
    return compare_hessians(swing_up, arguments.optimise);
  }
  const std::unique_ptr<Transcription> program =
      transcribe_swing_up(swing_up, example::transcription_options(arguments.optimise));
  const example::Optimised found = example::optimise(*program, arguments.optimise, ipopt_options());
  print(fmt::format("upright and at rest to {:.1e}; effort {:.6f}\n",
                    upright_error(program->trajectory_values(found.result.x)),
                    found.result.objective));
  return found.code;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  arguments.optimise.out = "results/swing_up";
  CLI::App app("A cart swings two rods up with the least effort.", "swing_up");
  example::add_options(app, arguments.optimise);
  app.add_option("--scene", arguments.scene, "The cart.");
  app.add_option("--steps", arguments.steps, "Of the 3 s.")
      ->check(CLI::Range(4, 100000))
      ->capture_default_str();
  CLI::Option* compare = app.add_flag("--compare", arguments.compare,
                                      "Solve with each kind of Hessian, and show how each ends.");
  app.add_flag("--scaling", arguments.scaling,
               "Measure the time of an iteration with 10^2, 10^3 and 10^4 steps.")
      ->excludes(compare);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  return run(arguments);
}

}  // namespace
}  // namespace hbar::swing_up

int main(int argc, char** argv) {
  hbar::example::prepare_process("swing_up");
  return hbar::example::guarded([&] { return hbar::swing_up::run_line(argc, argv); });
}
