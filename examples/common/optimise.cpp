#include "optimise.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <utility>

#include "examples/common/progress.h"
#include "hbar/adjoint/study/solution_file.h"
#include "hbar/adjoint/study/trajectory_csv.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/diagnosis.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"

namespace hbar::example {
namespace {

constexpr std::array<std::pair<solvers::HessianKind, std::string_view>, 3> kHessians = {
    {{solvers::HessianKind::kExact, "exact"},
     {solvers::HessianKind::kGaussNewton, "gauss-newton"},
     {solvers::HessianKind::kLimitedMemory, "limited-memory"}}};

/// Ipopt's own checker; of second derivatives where Ipopt is to use the exact ones.
void check_derivatives(Transcription& program, solvers::HessianKind kind) {
  const bool second = kind == solvers::HessianKind::kExact;
  const solvers::IpoptDerivativeTest test = solvers::test_derivatives_with_ipopt(
      program, second ? kind : solvers::HessianKind::kLimitedMemory);
  if (!test.passed()) {
    throw NumericalFailure(concat("Ipopt's derivative checker found ", test.errors,
                                  " wrong derivatives at the start:\n", test.text));
  }
  print(fmt::format("Ipopt's derivative checker finds no error in the first{} derivatives\n",
                    second ? " and second" : ""));
}

TranscriptionTimes difference(TranscriptionTimes after, const TranscriptionTimes& before) {
  after.simulation -= before.simulation;
  after.gradient -= before.gradient;
  after.jacobian -= before.jacobian;
  after.hessian -= before.hessian;
  after.simulations -= before.simulations;
  after.gradients -= before.gradients;
  after.jacobians -= before.jacobians;
  after.hessians -= before.hessians;
  return after;
}

ExitCode exit_code(const solvers::IpoptResult& result) {
  if (result.status == solvers::IpoptStatus::kInterrupted) {
    return ExitCode::kInterrupted;
  }
  return result.converged() ? ExitCode::kOk : ExitCode::kNotConverged;
}

}  // namespace

void add_options(CLI::App& app, OptimiseArguments& arguments) {
  app.add_option("--out", arguments.out, "Folder for the results.")->capture_default_str();
  app.add_option("--formulation", arguments.formulation,
                 "How the problem becomes a nonlinear program.")
      ->check(CLI::IsMember({"shooting", "multiple-shooting", "all-at-once"}))
      ->capture_default_str();
  app.add_option("--hessian", arguments.hessian, "Second derivatives that Ipopt gets.")
      ->check(CLI::IsMember({"exact", "gauss-newton", "limited-memory"}))
      ->capture_default_str();
  app.add_option("--resume", arguments.resume, "A solution.csv to start from.");
  app.add_option("--max-iterations", arguments.max_iterations, "Of Ipopt.")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--segments", arguments.segments, "Of multiple shooting.")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  add_save_option(app, arguments.save_every);
  app.add_flag("--check-derivatives", arguments.check_derivatives,
               "First let Ipopt compare all derivatives with differences, for which a coarse "
               "problem is enough.");
}

void add_save_option(CLI::App& app, double& save_every) {
  app.add_option("--save-every", save_every,
                 "Seconds after which the best point so far is written again to solution.csv.")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

std::string_view name_of(solvers::HessianKind kind) {
  for (const auto& [known, name] : kHessians) {
    if (known == kind) {
      return name;
    }
  }
  return "unknown";
}

solvers::HessianKind find_hessian(std::string_view name) {
  for (const auto& [kind, its_name] : kHessians) {
    if (its_name == name) {
      return kind;
    }
  }
  throw InvalidInput(
      concat("there is no Hessian '", name, "'; known: exact, gauss-newton, limited-memory"));
}

TranscriptionOptions transcription_options(const OptimiseArguments& arguments) {
  TranscriptionOptions options;
  options.formulation = find_formulation(arguments.formulation);
  options.segments = arguments.segments;
  return options;
}

solvers::IpoptResult solve_and_keep(solvers::Nlp& program, const solvers::IpoptOptions& options,
                                    const std::filesystem::path& solution,
                                    const std::map<std::string, std::string>& about) {
  solvers::IpoptResult result = solvers::solve_with_ipopt(
      program, study::saving_checkpoints(program, options, solution, about));
  try {
    study::save_result(program, result, solution, about);
  } catch (const IoError& error) {
    report_lost(error);
  }
  return result;
}

Optimised optimise(Transcription& program, const OptimiseArguments& arguments,
                   solvers::IpoptOptions options) {
  options.hessian = find_hessian(arguments.hessian);
  options.max_iterations = arguments.max_iterations;
  options.stop = &stop_flag();
  options.checkpoint_every = arguments.save_every;
  expect_results(arguments.out, {"solution.csv", "iterations.csv", "trajectory.csv"});
  if (!arguments.resume.empty()) {
    options.warm_start = study::load_solution(arguments.resume, program);
  }
  if (arguments.check_derivatives) {
    check_derivatives(program, options.hessian);
  }
  Progress progress;
  options.on_iteration = [&progress](const solvers::IterationInfo& info) {
    progress.show(info);
    return true;
  };
  print(fmt::format("{}: {} variables, {} constraints; Hessian: {}\n{}\n", arguments.formulation,
                    program.variables().start.size(), program.constraint_limits().lower.size(),
                    arguments.hessian, progress_heading()));

  const TranscriptionTimes before = program.times();
  Optimised out;
  out.result =
      solve_and_keep(program, options, arguments.out / "solution.csv",
                     {{"formulation", arguments.formulation}, {"hessian", arguments.hessian}});
  progress.end();
  out.iterations = progress.iterations();
  out.times = difference(program.times(), before);
  out.code = exit_code(out.result);

  write_result(arguments.out / "iterations.csv", iterations_csv(out.iterations));
  write_result(arguments.out / "trajectory.csv",
               study::trajectory_csv(study::trajectory_names(program.problem().horizon),
                                     program.trajectory_values(out.result.x)));
  solvers::DiagnosisOptions diagnosis;
  diagnosis.objective_scale = options.objective_scale;
  print(fmt::format("\n{}{}\nwritten: {}/solution.csv, iterations.csv, trajectory.csv\n",
                    solvers::diagnose(program, out.result, diagnosis).text(), time_line(out),
                    arguments.out.string()));
  return out;
}

std::string time_line(const Optimised& optimised) {
  const TranscriptionTimes& times = optimised.times;
  const double spent = times.simulation + times.gradient + times.jacobian + times.hessian;
  return fmt::format(
      "time: {:.2f} s in {} iterations: simulation {:.2f} s ({}), gradient {:.2f} s "
      "({}), Jacobian {:.2f} s ({}), Hessian {:.2f} s ({}), Ipopt {:.2f} s",
      optimised.result.elapsed, optimised.result.iterations, times.simulation, times.simulations,
      times.gradient, times.gradients, times.jacobian, times.jacobians, times.hessian,
      times.hessians, optimised.result.elapsed - spent);
}

}  // namespace hbar::example
