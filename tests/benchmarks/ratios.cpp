#include "tests/benchmarks/ratios.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <iomanip>
#include <ostream>

#include "tests/benchmarks/grasp.h"
#include "tests/benchmarks/workloads.h"

namespace hbar::benchmarks {
namespace {

using Work = std::function<void()>;

/// Processor time, which a busy machine's waiting does not enter.
double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

double seconds_per_call(const Work& work, int calls) {
  const double start = processor_seconds();
  for (int i = 0; i < calls; ++i) {
    work();
  }
  return (processor_seconds() - start) / calls;
}

/// Calls that take at least two milliseconds together.
int calls_per_measurement(const Work& work) {
  int calls = 1;
  while (seconds_per_call(work, calls) * calls < 2e-3) {
    calls *= 2;
  }
  return calls;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Times of several works that were measured in turn.
class Paired {
 public:
  Paired(const std::vector<Work>& works, int repetitions) : times_(works.size()) {
    std::vector<int> calls;
    for (const Work& work : works) {
      calls.push_back(calls_per_measurement(work));
    }
    for (int i = 0; i < repetitions; ++i) {
      for (std::size_t k = 0; k < works.size(); ++k) {
        times_[k].push_back(seconds_per_call(works[k], calls[k]));
      }
    }
  }

  /// Median time of a work, in `unit` seconds.
  [[nodiscard]] double time(std::size_t k, double unit) const { return median(times_[k]) / unit; }

  /// Median of the ratio of two works that were measured next to each other.
  [[nodiscard]] double ratio(std::size_t a, std::size_t b) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times_[a].size(); ++i) {
      ratios.push_back(times_[a][i] / times_[b][i]);
    }
    return median(ratios);
  }

 private:
  std::vector<std::vector<double>> times_;
};

void write_stage_ratios(int repetitions, std::ostream& out) {
  out << "Stage against mj_step (times in µs, target: blocks ≤ 1.5)\n\n"
      << "| model | mj_step | residual | + blocks | + Newton matrix | residual / mj_step | "
         "blocks / mj_step | Newton / mj_step |\n| --- | --- | --- | --- | --- | --- | --- | --- "
         "|\n";
  for (const HingeModel& hinges : all_models()) {
    StageWork work(hinges);
    const Paired paired({[&] { work.mujoco_step(); }, [&] { work.residual(); },
                         [&] { work.jacobian_blocks(); }, [&] { work.newton_matrix(); }},
                        repetitions);
    out << "| " << hinges.name;
    for (std::size_t k = 0; k < 4; ++k) {
      out << " | " << paired.time(k, 1e-6);
    }
    for (std::size_t k = 1; k < 4; ++k) {
      out << " | " << paired.ratio(k, 0);
    }
    out << " |\n" << std::flush;
  }
}

void write_gradient_ratios(const std::string& integrator, int repetitions, std::ostream& out) {
  out << "\n"
      << kSteps << " steps by " << integrator
      << " (times in ms, target: gradient ≤ 1.5 forward)\n\n"
      << "| model | parameters | forward | corrections per step | µs per correction | sweep | "
         "sweep / forward | (forward + sweep) / forward |\n"
      << "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const HingeModel& hinges : all_models()) {
    for (const int parameters : {1, 500}) {
      RolloutWork work(hinges, integrator, parameters);
      const Paired paired(
          {[&] { work.forward_alone(); }, [&] { work.sweep(); }, [&] { work.forward_and_sweep(); }},
          repetitions);
      out << "| " << hinges.name << " | " << work.parameter_count() << " | " << paired.time(0, 1e-3)
          << " | " << static_cast<double>(work.newton_iterations()) / kSteps << " | "
          << paired.time(0, 1e-6) / work.newton_iterations() << " | " << paired.time(1, 1e-3)
          << " | " << paired.ratio(1, 0) << " | " << paired.ratio(2, 0) << " |\n"
          << std::flush;
    }
  }
}

void write_difference_ratios(int repetitions, std::ostream& out) {
  out << "\nGradient of " << kSteps
      << " steps against MuJoCo's rollout with A, B at every step (times in ms, target at n = 32: "
         "≥ 10)\n\n| model | integrator | parameters | MuJoCo rollout | with A, B | forward + "
         "sweep "
         "| MuJoCo with A, B / hbar |\n| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const HingeModel& hinges : {hand(), serial_chain(32)}) {
    for (const char* integrator : {"bdf1", "bdf2"}) {
      for (const int parameters : {1, 500}) {
        RolloutWork work(hinges, integrator, parameters);
        const Paired paired(
            {[&] { work.mujoco_rollout(); }, [&] { work.mujoco_rollout_with_A_B(); },
             [&] { work.forward_and_sweep(); }},
            std::max(3, repetitions / 5));
        out << "| " << hinges.name << " | " << integrator << " | " << work.parameter_count()
            << " | " << paired.time(0, 1e-3) << " | " << paired.time(1, 1e-3) << " | "
            << paired.time(2, 1e-3) << " | " << paired.ratio(1, 2) << " |\n"
            << std::flush;
      }
    }
  }
}

/// What contact costs: evaluations with it less those without, times how often each is made.
void write_grasp(int repetitions, std::ostream& out) {
  out << "\nA hand of five fingers holding a free cube, " << kSteps
      << " steps (µs per step; targets: contact ≤ 50 % of a step, gradient ≤ 2 forward)\n\n"
      << "| integrator | points | touching, mean | most | parameters | corrections | forward | "
         "contact in it | sweep | contact in it | (forward + sweep) / forward | slip, mm |\n"
      << "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const char* integrator : {"bdf1", "bdf2"}) {
    GraspWork work(integrator);
    const Paired paired(
        {[&] { work.forward_alone(); }, [&] { work.sweep(); }, [&] { work.forward_and_sweep(); },
         [&] { work.newton_matrix(); }, [&] { work.newton_matrix_without(); },
         [&] { work.residual(); }, [&] { work.residual_without(); }, [&] { work.pull_back(); },
         [&] { work.pull_back_without(); }},
        repetitions);
    const auto contact = [&](std::size_t with) {
      return paired.time(with, 1.0) - paired.time(with + 1, 1.0);
    };
    // Newton evaluates a residual after every correction but a stage's last.
    const double in_forward = contact(3) * work.factorizations() +
                              contact(5) * (work.newton_iterations() - work.stages());
    const double in_sweep = contact(7) * work.stages();
    out << "| " << integrator << " | " << work.declared_points() << " | "
        << work.mean_active_points() << " | " << work.most_active_points() << " | "
        << work.parameter_count() << " | " << static_cast<double>(work.newton_iterations()) / kSteps
        << " | " << paired.time(0, 1e-6) / kSteps << " | "
        << 100.0 * in_forward / paired.time(0, 1.0) << " % | " << paired.time(1, 1e-6) / kSteps
        << " | " << 100.0 * in_sweep / paired.time(1, 1.0) << " % | " << paired.ratio(2, 0) << " | "
        << 1e3 * work.slip() << " |\n"
        << std::flush;
  }
}

}  // namespace

void write_ratios(int repetitions, std::ostream& out) {
  out << std::fixed << std::setprecision(2);
  write_stage_ratios(4 * repetitions, out);
  write_gradient_ratios("bdf1", repetitions, out);
  write_gradient_ratios("bdf2", repetitions, out);
  write_difference_ratios(repetitions, out);
  write_grasp(repetitions, out);
}

void write_grasp_ratios(int repetitions, std::ostream& out) {
  out << std::fixed << std::setprecision(2);
  write_grasp(repetitions, out);
}

}  // namespace hbar::benchmarks
