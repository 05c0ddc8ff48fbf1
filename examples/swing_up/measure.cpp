#include "measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>

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
  return fmt::format("{:<15} {:<35} {:>10} {:>6} {:>9} {:>9} {:>8} {:>12.8f} {:>8.2f} s\n", kind,
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

/// Adds the CPU time until its end to a sum.
class CpuTimer {
 public:
  explicit CpuTimer(double& sum) : sum_(sum), begin_(cpu_time()) {}
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;
  ~CpuTimer() { sum_ += cpu_time() - begin_; }

 private:
  double& sum_;
  double begin_;
};

/// A program whose evaluations are timed.
class TimedProgram final : public solvers::Nlp {
 public:
  TimedProgram(solvers::Nlp& program, IterationCost& cost) : program_(program), cost_(cost) {}

  [[nodiscard]] const solvers::NlpVariables& variables() const override {
    return program_.variables();
  }
  [[nodiscard]] const solvers::NlpConstraints& constraint_limits() const override {
    return program_.constraint_limits();
  }
  [[nodiscard]] const solvers::SparsityPattern& jacobian_pattern() const override {
    return program_.jacobian_pattern();
  }
  [[nodiscard]] const solvers::SparsityPattern& hessian_pattern(HessianKind kind) override {
    return program_.hessian_pattern(kind);
  }
  [[nodiscard]] double objective(const Eigen::VectorXd& x) override {
    const CpuTimer timer(cost_.values);
    return program_.objective(x);
  }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override {
    const CpuTimer timer(cost_.values);
    program_.constraints(x, c);
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    const CpuTimer timer(cost_.first);
    program_.objective_gradient(x, g);
  }
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override {
    const CpuTimer timer(cost_.first);
    program_.constraint_jacobian(x, values);
  }
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd& lambda,
                          HessianKind kind, Eigen::VectorXd& values) override {
    const CpuTimer timer(cost_.hessian);
    program_.lagrangian_hessian(x, sigma, lambda, kind, values);
  }

 private:
  solvers::Nlp& program_;
  IterationCost& cost_;
};

IterationCost measure_once(const SwingUp& swing_up, int steps) {
  constexpr int kIterations = 6;
  IterationCost cost;
  cost.steps = steps;
  std::unique_ptr<Transcription> program;
  {
    const CpuTimer timer(cost.set_up);
    program = begin(swing_up, example::OptimiseArguments());
    static_cast<void>(program->hessian_pattern(HessianKind::kExact));
  }
  solvers::IpoptOptions options = ipopt_options();
  options.hessian = HessianKind::kExact;
  options.max_iterations = kIterations;
  options.stop = &example::stop_flag();
  TimedProgram timed(*program, cost);
  int count = 1;
  {
    const CpuTimer timer(cost.total);
    count = std::max(1, solvers::solve_with_ipopt(timed, options).iterations);
  }
  for (double* time : {&cost.total, &cost.values, &cost.first, &cost.hessian}) {
    *time /= count;
  }
  cost.optimiser = cost.total - cost.values - cost.first - cost.hessian;
  return cost;
}

/// The exponent with which a time grows from one number of steps to another.
double exponent(const IterationCost& a, const IterationCost& b, double before, double after) {
  return std::log(after / before) /
         std::log(static_cast<double>(b.steps) / static_cast<double>(a.steps));
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
  std::string table = fmt::format("\n{:<15} {:<35} {:>10} {:>6} {:>9} {:>9} {:>8} {:>12} {:>10}\n",
                                  "Hessian", "ended", "iterations", "values", "gradients",
                                  "Jacobians", "Hessians", "effort", "CPU time");
  example::OptimiseArguments arguments = given;
  example::ExitCode code = example::ExitCode::kOk;
  for (const HessianKind kind :
       {HessianKind::kExact, HessianKind::kGaussNewton, HessianKind::kLimitedMemory}) {
    arguments.hessian = example::name_of(kind);
    arguments.out = given.out / arguments.hessian;
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
    const IterationCost& a = costs[i - 1];
    const IterationCost& b = costs[i];
    text += fmt::format(
        "from {} to {} steps: exponent {:.2f}, of hbar's part {:.2f}, of Ipopt's {:.2f}\n", a.steps,
        b.steps, exponent(a, b, a.total, b.total),
        exponent(a, b, a.total - a.optimiser, b.total - b.optimiser),
        exponent(a, b, a.optimiser, b.optimiser));
  }
  return text;
}

}  // namespace hbar::swing_up
