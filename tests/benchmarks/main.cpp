// hbar beside MuJoCo on the same models (doc/performance.md).
//
//   hbar_benchmarks                  every benchmark on its own; Google Benchmark's options apply
//   hbar_benchmarks --ratios [N]     tables of ratios, medians over N repetitions (default 15)
//   hbar_benchmarks --grasp [N]      the table of the grasp with contact alone
//   hbar_benchmarks --systems [N]    solving with H, and its growth with the steps (doc/solvers.md)
//   hbar_benchmarks --second-order [N]   Hessian-vector products against gradients
//   hbar_benchmarks --repeat WORK MODEL N   one work N times, for a profiler

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <span>

#include "hbar/core/base/error.h"
#include "tests/benchmarks/ratios.h"
#include "tests/benchmarks/second_order_ratios.h"
#include "tests/benchmarks/system_ratios.h"
#include "tests/benchmarks/workloads.h"

namespace hbar::benchmarks {
namespace {

struct NamedWork {
  std::string name;
  std::function<void()> work;
};

std::vector<NamedWork> stage_works(const HingeModel& hinges) {
  const auto stage = std::make_shared<StageWork>(hinges);
  return {{"residual", [stage] { stage->residual(); }},
          {"jacobian_blocks", [stage] { stage->jacobian_blocks(); }},
          {"newton_matrix", [stage] { stage->newton_matrix(); }},
          {"mujoco_step", [stage] { stage->mujoco_step(); }}};
}

std::vector<NamedWork> rollout_works(const HingeModel& hinges) {
  std::vector<NamedWork> works;
  for (const char* integrator : {"bdf1", "bdf2"}) {
    for (const int parameters : {1, 500}) {
      const auto rollout = std::make_shared<RolloutWork>(hinges, integrator, parameters);
      const std::string suffix = concat("_", integrator, "_", parameters);
      works.push_back({"sweep" + suffix, [rollout] { rollout->sweep(); }});
      works.push_back({"forward_and_sweep" + suffix, [rollout] { rollout->forward_and_sweep(); }});
      if (parameters == 1) {
        works.push_back({concat("forward_", integrator), [rollout] { rollout->forward_alone(); }});
      }
    }
  }
  const auto rollout = std::make_shared<RolloutWork>(hinges, "bdf1", 1);
  works.push_back({"mujoco_rollout", [rollout] { rollout->mujoco_rollout(); }});
  works.push_back({"mujoco_rollout_with_A_B", [rollout] { rollout->mujoco_rollout_with_A_B(); }});
  return works;
}

void register_all() {
  for (const HingeModel& hinges : all_models()) {
    for (const auto& works : {stage_works(hinges), rollout_works(hinges)}) {
      for (const NamedWork& named : works) {
        benchmark::RegisterBenchmark(concat(hinges.name, "/", named.name).c_str(),
                                     [work = named.work](benchmark::State& state) {
                                       for (auto _ : state) {
                                         work();
                                       }
                                     });
      }
    }
  }
}

int repeat(const std::string& work, const std::string& model, int times) {
  for (const HingeModel& hinges : all_models()) {
    if (hinges.name != model) {
      continue;
    }
    for (const auto& make : {stage_works, rollout_works}) {
      for (const NamedWork& named : make(hinges)) {
        if (named.name == work) {
          for (int i = 0; i < times; ++i) {
            named.work();
          }
          return 0;
        }
      }
    }
  }
  std::cerr << "no work '" << work << "' of a model '" << model << "'\n";
  return 1;
}

int run(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const std::string first = argc > 1 ? arguments[1] : "";
  if (first == "--ratios") {
    write_ratios(argc > 2 ? std::atoi(arguments[2]) : 15, std::cout);
    return 0;
  }
  if (first == "--grasp") {
    write_grasp_ratios(argc > 2 ? std::atoi(arguments[2]) : 15, std::cout);
    return 0;
  }
  if (first == "--systems") {
    write_system_ratios(argc > 2 ? std::atoi(arguments[2]) : 5, std::cout);
    return 0;
  }
  if (first == "--second-order") {
    write_second_order_ratios(argc > 2 ? std::atoi(arguments[2]) : 5, std::cout);
    return 0;
  }
  if (first == "--repeat" && argc == 5) {
    return repeat(arguments[2], arguments[3], std::atoi(arguments[4]));
  }
  register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace hbar::benchmarks

int main(int argc, char** argv) {
  try {
    return hbar::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
