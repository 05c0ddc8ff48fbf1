// A periodic gait of a planar biped on the ground: torques, the initial state and the lengths of
// thighs and shanks, such that the cost of transport is least.
//
//   cmake --build build/release --target walker
//   build/release/examples/walker/walker
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv,
// solution.csv and iterations.csv into results/walker. doc/walker.md tells what is solved and
// found.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <vector>

#include "examples/common/progress.h"
#include "report.h"

namespace hbar::walker {
namespace {

using example::ExitCode;

struct Arguments {
  example::OptimiseArguments optimise;
  Plan plan;
};

/// Something to minimise on the way, and where its files go.
struct Step {
  const char* title;
  Aim aim;
  const char* folder;  // within the results
  bool given_lengths;
};

constexpr std::array<Step, 3> kSteps = {
    {{"some gait near the first guess, with given lengths", Aim::kFollowGuess, "first", true},
     {"least cost with wide corners, the same lengths", Aim::kSmoothedCost, "smoothed", true},
     {"least cost of transport", Aim::kCostOfTransport, "", false}}};

std::filesystem::path folder_of(const Step& step, const Arguments& arguments) {
  const std::string_view folder = step.folder;
  return folder.empty() ? arguments.optimise.out : arguments.optimise.out / folder;
}

Stage solve(const Step& step, Arguments arguments, const std::vector<Stage>& earlier) {
  arguments.optimise.out = folder_of(step, arguments);
  if (step.aim != Aim::kCostOfTransport) {
    arguments.optimise.resume.clear();
  }
  if (step.given_lengths) {
    arguments.plan.length_share = 0.0;
  }
  const TrajectoryProblem problem = walker_problem(arguments.plan, step.aim);
  TranscriptionOptions transcription = example::transcription_options(arguments.optimise);
  transcription.q_guess = first_guess(arguments.plan, problem.horizon.model());
  Stage stage;
  stage.program = transcribe(problem, transcription);
  stage.outcome = example::optimise(
      *stage.program, arguments.optimise,
      ipopt_options(step.aim, earlier.empty() ? nullptr : &earlier.back().outcome.result));
  const Eigen::VectorXd& x = stage.outcome.result.x;
  stage.gait = examine(arguments.plan, stage.program->problem(),
                       stage.program->trajectory_values(x), stage.program->design(x));
  return stage;
}

ExitCode run(const Arguments& arguments) {
  const example::StopsGently gently;
  example::expect_results(arguments.optimise.out, {"result.json"}, {arguments.plan.scene});
  std::vector<Stage> stages;
  for (const Step& step : kSteps) {
    example::print(fmt::format("\nwalker: {}\n", step.title));
    stages.push_back(solve(step, arguments, stages));
    const example::Optimised& outcome = stages.back().outcome;
    if (outcome.code == ExitCode::kInterrupted || !outcome.result.feasible) {
      return outcome.code;
    }
  }
  example::write_result(arguments.optimise.out / "result.json",
                        result_json(arguments.plan, stages));
  example::print(summary(arguments.plan, stages));
  return stages.back().outcome.code;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  arguments.optimise.out = "results/walker";
  arguments.plan.scene = HBAR_SOURCE_DIR "/examples/scenes/walker.xml";
  std::string lengths = "free";
  CLI::App app("A periodic gait of a biped with the least cost of transport.", "walker");
  example::add_options(app, arguments.optimise);
  app.add_option("--scene", arguments.plan.scene, "The biped.");
  app.add_option("--lengths", lengths, "Of thighs and shanks: free, or fixed at the scene's.")
      ->check(CLI::IsMember({"free", "fixed"}))
      ->capture_default_str();
  app.add_option("--begin", arguments.plan.begin, "Thigh and shank to begin with, m.")->expected(2);
  app.add_option("--steps", arguments.plan.steps, "Of half a gait.")
      ->check(CLI::Range(10, 1000))
      ->capture_default_str();
  app.add_option("--speed", arguments.plan.speed, "Average, m/s.")->capture_default_str();
  app.add_option("--duration", arguments.plan.duration, "Of half a gait, s.")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  if (lengths == "fixed") {
    arguments.plan.length_share = 0.0;
  }
  if (find_formulation(arguments.optimise.formulation) == Formulation::kMultipleShooting) {
    arguments.plan.restarts = segment_starts(arguments.plan.steps, arguments.optimise.segments);
  }
  return run(arguments);
}

}  // namespace
}  // namespace hbar::walker

int main(int argc, char** argv) {
  hbar::example::prepare_process("walker");
  return hbar::example::guarded([&] { return hbar::walker::run_line(argc, argv); });
}
