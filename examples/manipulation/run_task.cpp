#include "run_task.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "examples/common/optimise.h"
#include "examples/common/progress.h"
#include "hbar/adjoint/study/solution_file.h"
#include "hbar/adjoint/study/trajectory_csv.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::manipulation {
namespace {

using Json = nlohmann::ordered_json;

/// @param enough  relative change of the objective at which five iterations in a row end a stage
solvers::IpoptOptions ipopt_options(const TaskOptions& options, int iterations_left,
                                    double enough) {
  solvers::IpoptOptions ipopt;
  ipopt.tolerance = 2e-3;
  ipopt.acceptable_tolerance = 1e2;
  ipopt.max_iterations = iterations_left;
  ipopt.integer_options["limited_memory_max_history"] = 30;
  ipopt.integer_options["acceptable_iter"] = 5;
  ipopt.number_options["acceptable_obj_change_tol"] = enough;
  ipopt.number_options["mu_init"] = 1e-3;
  ipopt.string_options["nlp_scaling_method"] = "none";
  ipopt.stop = options.stop;
  ipopt.checkpoint_every = options.save_every;
  ipopt.on_iteration = [&options](const solvers::IterationInfo& info) {
    if (options.on_iteration) {
      options.on_iteration(info);
    }
    return true;
  };
  return ipopt;
}

std::string summary(const Task& task, const TaskResult& result) {
  std::string text = fmt::format("result:      {}\n", result.last.message);
  text += fmt::format("iterations:  {}\nobjective:   {:.6f} -> {:.6f}\n", result.iterations,
                      result.start_objective, result.last.objective);
  for (std::size_t i = 0; i < task.goals.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    text += fmt::format("goal:        {:<10} {:+.4f} +- {:g}: off by {:.5f} (first guess {:.5f})\n",
                        task.goals[i].coordinate, task.goals[i].target, task.goals[i].tolerance,
                        result.errors[k], result.start_errors[k]);
  }
  const Eigen::VectorXd lengths = result.problem->design(result.last.x);
  for (std::size_t i = 0; i < task.lengths.size(); ++i) {
    text += fmt::format("length:      {:<16} {:.2f} mm\n", task.lengths[i].segments.front().body,
                        1e3 * lengths[static_cast<Eigen::Index>(i)]);
  }
  const TranscriptionTimes& times = result.problem->times();
  text += fmt::format("time:        {:.1f} s, of which {:.1f} s simulations, {:.1f} s gradients\n",
                      result.last.elapsed, times.simulation, times.gradient);
  return text + (result.reached(task) ? "goals:       all reached\n" : "goals:       MISSED\n");
}

Json list(const Eigen::VectorXd& numbers) {
  return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
}

std::string result_json(const Task& task, const TaskResult& result) {
  Json out = {{"task", task.name},
              {"status", std::string(solvers::to_string(result.last.status))},
              {"reached", result.reached(task)},
              {"iterations", result.iterations},
              {"start_objective", result.start_objective},
              {"objective", result.last.objective},
              {"variable_names", result.problem->variables().names},
              {"x", list(result.last.x)}};
  out["goals"] = Json::array();
  for (std::size_t i = 0; i < task.goals.size(); ++i) {
    out["goals"].push_back({{"coordinate", task.goals[i].coordinate},
                            {"target", task.goals[i].target},
                            {"tolerance", task.goals[i].tolerance},
                            {"error", result.errors[static_cast<Eigen::Index>(i)]}});
  }
  return out.dump(1) + '\n';
}

constexpr const char* kScaleEntry = "contact scale";

/// The stage that a solution was saved in.
double stage_of(const std::filesystem::path& file) {
  const std::map<std::string, std::string> about = study::read_solution(file).about;
  const auto entry = about.find(kScaleEntry);
  std::string reason;
  const std::optional<double> scale =
      entry == about.end() ? std::nullopt : scene::parse_number(entry->second, reason);
  if (!scale) {
    throw InvalidInput(concat(file.string(), ": no \"", kScaleEntry,
                              "\" is told: this is no solution of a manipulation task"));
  }
  return *scale;
}

/// One stage, from a point with or without multipliers.
solvers::IpoptResult solve_stage(Transcription& program, const solvers::IpoptOptions& ipopt,
                                 double scale, const TaskOptions& options) {
  if (options.solution.empty()) {
    return solvers::solve_with_ipopt(program, ipopt);
  }
  return example::solve_and_keep(program, ipopt, options.solution,
                                 {{kScaleEntry, scene::format_number(scale)}});
}

example::ExitCode run(const Task& task, const std::filesystem::path& out, TaskOptions options) {
  const example::StopsGently gently;
  example::expect_results(out, {"result.json", "solution.csv", "trajectory.csv", "iterations.csv"},
                          {task.scene});
  example::print(fmt::format("{}: {}\n{}\n", task.name, task.title, example::progress_heading()));
  example::Progress progress;
  options.solution = out / "solution.csv";
  options.stop = &example::stop_flag();
  options.on_iteration = [&](const solvers::IterationInfo& info) { progress.show(info); };
  const TaskResult result = solve_task(task, options);
  progress.end();
  example::write_result(out / "result.json", result_json(task, result));
  example::write_result(
      out / "trajectory.csv",
      study::trajectory_csv(study::trajectory_names(result.problem->problem().horizon),
                            result.values));
  example::write_result(out / "iterations.csv", example::iterations_csv(progress.iterations()));
  example::print(summary(task, result));
  example::print(
      fmt::format("written:     {}/result.json, solution.csv, trajectory.csv, "
                  "iterations.csv\n",
                  out.string()));
  if (result.last.status == solvers::IpoptStatus::kInterrupted) {
    return example::ExitCode::kInterrupted;
  }
  return result.last.converged() && result.reached(task) ? example::ExitCode::kOk
                                                         : example::ExitCode::kNotConverged;
}

}  // namespace

bool TaskResult::reached(const Task& task) const {
  for (std::size_t i = 0; i < task.goals.size(); ++i) {
    if (!(errors[static_cast<Eigen::Index>(i)] <= task.goals[i].tolerance)) {
      return false;
    }
  }
  return true;
}

TaskResult solve_task(const Task& task, const TaskOptions& options) {
  TaskResult out;
  {
    const auto full = make_problem(task, 1.0);
    out.start_errors = goal_errors(task, full->problem().horizon.model(),
                                   full->trajectory_values(full->variables().start));
  }
  Eigen::VectorXd x;
  const double first = options.resume.empty() ? 0.0 : stage_of(options.resume);
  for (const double scale : task.contact_scales) {
    if (!options.resume.empty() && x.size() == 0 && scale != first) {
      continue;
    }
    out.problem = make_problem(task, scale, x);
    if (x.size() == 0) {
      out.start_objective = out.problem->objective(out.problem->variables().start);
    }
    const bool resumed = !options.resume.empty() && x.size() == 0;
    // Only the last stage is worth the last digits.
    const double enough = scale == task.contact_scales.back() ? task.enough : 6e-2;
    solvers::IpoptOptions ipopt =
        ipopt_options(options, options.max_iterations - out.iterations, enough);
    if (resumed) {
      ipopt.warm_start = study::load_solution(options.resume, *out.problem);
    }
    out.last = solve_stage(*out.problem, ipopt, scale, options);
    out.iterations += out.last.iterations;
    x = out.last.x;
    if (out.last.status == solvers::IpoptStatus::kInterrupted) {
      break;
    }
  }
  if (out.problem == nullptr) {
    throw InvalidInput(
        concat(options.resume.string(), ": its contact scale ", first, " is none of this task's"));
  }
  out.values = out.problem->trajectory_values(out.last.x);
  out.errors = goal_errors(task, out.problem->problem().horizon.model(), out.values);
  return out;
}

example::ExitCode run_task(const Task& task, int argc, char** argv) {
  std::filesystem::path out = "results/" + task.name;
  TaskOptions options;
  CLI::App app(task.title, task.name);
  app.add_option("--out", out, "Folder for the results.")->capture_default_str();
  app.add_option("--max-iterations", options.max_iterations, "Of Ipopt.")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--resume", options.resume, "A solution.csv to start from.");
  example::add_save_option(app, options.save_every);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? example::ExitCode::kOk : example::ExitCode::kUsage;
  }
  return run(task, out, std::move(options));
}

}  // namespace hbar::manipulation
