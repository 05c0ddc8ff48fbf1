#include "measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "examples/common/progress.h"

namespace hbar::swing_up {
namespace {

using example::print;
using solvers::HessianKind;

constexpr double kBarrier = 1e-4;  // held, for the order of convergence
constexpr double kRounding = 1e-12;

double cpu_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::unique_ptr<Transcription> begin(const SwingUp& swing_up,
                                     const example::OptimiseArguments& arguments) {
  return transcribe_swing_up(swing_up, example::transcription_options(arguments));
}

std::string compared(const char* kind, const example::Optimised& found, double seconds) {
  const solvers::EvaluationCounts& n = found.result.evaluations;
  return fmt::format("{:<16} {:<16} {:>10} {:>6} {:>9} {:>9} {:>8} {:>12.8f} {:>8.2f} s\n", kind,
                     solvers::to_string(found.result.status), found.result.iterations, n.objective,
                     n.gradient, n.jacobian, n.hessian, found.result.objective, seconds);
}

std::string tail_table(const std::vector<TailStep>& tail) {
  std::string text =
      fmt::format("\n{:>9} {:>12} {:>7} {:>6}\n", "iteration", "step", "log10", "order");
  for (const TailStep& step : tail) {
    text += fmt::format("{:>9} {:>12.3e} {:>7.2f} ", step.iteration, step.step_norm,
                        std::log10(step.step_norm));
    text += step.order > 0.0 ? fmt::format("{:>6.2f}\n", step.order) : std::string("\n");
  }
  return text;
}

IterationCost measure_once(const SwingUp& swing_up, int steps) {
  constexpr int kIterations = 6;
  IterationCost cost;
  cost.steps = steps;
  const double beginning = cpu_time();
  example::OptimiseArguments arguments;
  const std::unique_ptr<Transcription> program = begin(swing_up, arguments);
  static_cast<void>(program->hessian_pattern(HessianKind::kExact));
  const double start = cpu_time();
  cost.set_up = start - beginning;
  const TranscriptionTimes before = program->times();
  solvers::IpoptOptions options = ipopt_options();
  options.hessian = HessianKind::kExact;
  options.max_iterations = kIterations;
  options.stop = &example::stop_flag();
  const solvers::IpoptResult result = solvers::solve_with_ipopt(*program, options);
  const TranscriptionTimes& after = program->times();
  const int count = std::max(1, result.iterations);
  cost.total = (cpu_time() - start) / count;
  cost.values = (after.simulation - before.simulation) / count;
  cost.first = (after.gradient - before.gradient + after.jacobian - before.jacobian) / count;
  cost.hessian = (after.hessian - before.hessian) / count;
  cost.optimiser = result.elapsed / count - cost.values - cost.first - cost.hessian;
  return cost;
}

}  // namespace

std::vector<TailStep> convergence_tail(const std::vector<solvers::IterationInfo>& iterations) {
  std::vector<TailStep> tail;
  for (const solvers::IterationInfo& info : iterations) {
    if (info.alpha_primal < 1.0 || info.regularization > 0.0 || info.step_norm >= 1.0) {
      tail.clear();
      continue;
    }
    if (info.step_norm < kRounding) {
      break;
    }
    TailStep next{info.iteration, info.step_norm, 0.0};
    const std::size_t n = tail.size();
    if (n >= 2) {
      next.order = std::log(next.step_norm / tail[n - 1].step_norm) /
                   std::log(tail[n - 1].step_norm / tail[n - 2].step_norm);
    }
    tail.push_back(next);
  }
  return tail;
}

example::ExitCode compare_hessians(const SwingUp& swing_up,
                                   const example::OptimiseArguments& given) {
  std::string table = fmt::format("\n{:<16} {:<16} {:>10} {:>6} {:>9} {:>9} {:>8} {:>12} {:>10}\n",
                                  "Hessian", "ended", "iterations", "values", "gradients",
                                  "Jacobians", "Hessians", "effort", "CPU time");
  example::OptimiseArguments arguments = given;
  example::ExitCode code = example::ExitCode::kOk;
  for (const HessianKind kind :
       {HessianKind::kExact, HessianKind::kGaussNewton, HessianKind::kLimitedMemory}) {
    arguments.hessian = example::name_of(kind);
    arguments.out = given.out / arguments.hessian;
    example::make_folder(arguments.out);
    const std::unique_ptr<Transcription> program = begin(swing_up, arguments);
    const double start = cpu_time();
    const example::Optimised found = example::optimise(*program, arguments, ipopt_options());
    table += compared(arguments.hessian.c_str(), found, cpu_time() - start);
    if (found.code == example::ExitCode::kInterrupted) {
      return found.code;
    }
    if (kind == HessianKind::kExact) {
      code = found.code;
    }
  }
  arguments.hessian = example::name_of(HessianKind::kExact);
  arguments.out = given.out / "fixed-barrier";
  example::make_folder(arguments.out);
  const std::unique_ptr<Transcription> program = begin(swing_up, arguments);
  const example::Optimised found =
      example::optimise(*program, arguments, fixed_barrier_options(kBarrier));
  table += fmt::format("\nThe barrier parameter held at {:.0e}, exact Hessian, last full steps:",
                       kBarrier);
  print(table + tail_table(convergence_tail(found.iterations)));
  return code;
}

std::vector<IterationCost> measure_scaling(const std::filesystem::path& scene,
                                           const std::vector<int>& steps) {
  constexpr int kRuns = 3;
  std::vector<IterationCost> out;
  for (const int count : steps) {
    const SwingUp swing_up = make_swing_up(scene, count);
    IterationCost best = measure_once(swing_up, count);
    for (int run = 1; run < kRuns; ++run) {
      const IterationCost next = measure_once(swing_up, count);
      best = next.total < best.total ? next : best;
    }
    out.push_back(best);
  }
  return out;
}

std::string scaling_table(const std::vector<IterationCost>& costs) {
  constexpr double kMs = 1e3;
  std::string text =
      fmt::format("{:>6} {:>12} {:>14} {:>12} {:>12} {:>12} {:>12}\n", "steps", "set-up",
                  "an iteration", "values", "gradient, J", "Hessian", "Ipopt");
  for (const IterationCost& c : costs) {
    text += fmt::format(
        "{:>6} {:>9.1f} ms {:>11.2f} ms {:>9.2f} ms {:>9.2f} ms {:>9.2f} ms {:>9.2f} ms\n", c.steps,
        kMs * c.set_up, kMs * c.total, kMs * c.values, kMs * c.first, kMs * c.hessian,
        kMs * c.optimiser);
  }
  for (std::size_t i = 1; i < costs.size(); ++i) {
    const double growth =
        std::log(static_cast<double>(costs[i].steps) / static_cast<double>(costs[i - 1].steps));
    text += fmt::format("growth from {} to {} steps: exponent {:.2f}\n", costs[i - 1].steps,
                        costs[i].steps, std::log(costs[i].total / costs[i - 1].total) / growth);
  }
  return text;
}

}  // namespace hbar::swing_up
