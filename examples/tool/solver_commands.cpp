#include "solver_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "examples/common/progress_bar.h"
#include "examples/solver_benchmark/corpus.h"
#include "examples/solver_benchmark/families.h"
#include "examples/solver_benchmark/gnuplot.h"
#include "examples/solver_benchmark/plots.h"
#include "examples/solver_benchmark/run_benchmark.h"
#include "examples/solver_benchmark/sidecar.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"
#include "hbar/suite.h"
#include "outputs.h"

namespace hbar::tool {

using example::ExitCode;
using example::print;
using example::ProgramError;
using example::stop_flag;
namespace {

namespace fs = std::filesystem;
namespace benchmark = solver_benchmark;
using benchmark::BenchmarkMatrix;
using benchmark::BenchmarkPlan;
using benchmark::BenchmarkResults;
using benchmark::Case;
using benchmark::CorpusSize;
using benchmark::Plot;

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const benchmark::Family& family : benchmark::families()) {
    names.push_back(family.name);
  }
  return names;
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names = {"auto"};
  for (const solvers::SolverEntry& entry : solvers::available_solvers()) {
    names.push_back(entry.name);
  }
  return names;
}

std::vector<solvers::Ordering> orderings(const std::vector<std::string>& given) {
  using solvers::Ordering;
  constexpr std::array kAll = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                               Ordering::kColamd,  Ordering::kMetis,   Ordering::kNested};
  if (given == std::vector<std::string>{"all"}) {
    return {kAll.begin(), kAll.end()};
  }
  std::vector<std::string> names;
  for (const Ordering ordering : kAll) {
    names.emplace_back(name_of(ordering));
  }
  std::vector<Ordering> out;
  for (const std::string& name : given) {
    check_name("--ordering", name, names);
    out.push_back(solvers::find_ordering(name));
  }
  return out;
}

/// Every combination; those that share a simulation follow each other.
std::vector<Case> cases_of(const SolverArguments& arguments) {
  std::vector<Case> models;
  for (const std::string& file : arguments.scenes) {
    static_cast<void>(scene::read_text_file(file));  // what is missing is said at once
    models.push_back({.scene = file});
  }
  const bool all = arguments.families == std::vector<std::string>{"all"};
  for (const std::string& family : all ? family_names() : arguments.families) {
    check_name("--family", family, family_names());
    for (const int joints : arguments.joints) {
      if (joints < benchmark::find_family(family).smallest) {
        usage(fmt::format("--dof: family {} needs at least {} joints, not {}", family,
                          benchmark::find_family(family).smallest, joints));
      }
      models.push_back({.family = family, .joints = joints});
    }
  }
  std::vector<Case> cases;
  for (Case which : models) {
    for (const int steps : arguments.steps) {
      for (const std::string& integrator : arguments.integrators) {
        for (const std::string& system : arguments.systems) {
          which.steps = steps;
          which.integrator = integrator;
          which.system = find_system_kind(system);
          cases.push_back(which);
        }
      }
    }
  }
  return cases;
}

BenchmarkPlan plan_of(const SolverArguments& arguments) {
  BenchmarkPlan plan;
  plan.cases = cases_of(arguments);
  plan.solvers = arguments.solvers;
  for (const std::string& solver : plan.solvers) {
    check_name("--solver", solver, solver_names());
  }
  if (!arguments.structure.empty()) {
    check_name("--structure", arguments.structure, benchmark::structure_names());
  }
  plan.orderings = orderings(arguments.orderings);
  try {
    benchmark::check_plan(plan);
  } catch (const InvalidInput& error) {
    usage(fmt::format("--ordering: {}", error.what()));
  }
  plan.options.clock = arguments.clock == "cpu" ? benchmark::Clock::kCpu : benchmark::Clock::kWall;
  plan.options.rhs = arguments.rhs;
  plan.options.repeat = arguments.repeat;
  plan.stop = &stop_flag();
  if (arguments.matrices) {
    plan.files = benchmark::find_matrix_files(*arguments.matrices);
    plan.structure = arguments.structure;
  }
  return plan;
}

/// Refuses what could not be written before anything is measured.
void check_outputs(const SolverArguments& arguments, const BenchmarkPlan& plan) {
  std::vector<fs::path> inputs(arguments.scenes.begin(), arguments.scenes.end());
  inputs.insert(inputs.end(), plan.files.begin(), plan.files.end());
  check_output(arguments.json, inputs);
  check_output(arguments.csv, inputs);
  check_distinct("--json", arguments.json, "--csv", arguments.csv);
  if (arguments.plots) {
    if (!benchmark::has_gnuplot()) {
      throw ProgramError(
          ExitCode::kInputOutput,
          "--plots: gnuplot, which draws them, was not found (Debian: apt-get install "
          "gnuplot-nox)");
    }
    example::expect_results(*arguments.plots, {"profile.svg"}, inputs);
  }
}

/// Of the first matrix of each kind of system.
class SpyPlots {
 public:
  void add(const BenchmarkMatrix& matrix) {
    if (seen_.insert(matrix.label.system).second) {
      plots.push_back(benchmark::spy_plot(matrix));
    }
  }
  std::vector<Plot> plots;

 private:
  std::set<std::string> seen_;
};

void write_files(const SolverArguments& arguments, const BenchmarkResults& results) {
  if (arguments.json) {
    write_output(*arguments.json, benchmark::results_json(results));
  }
  if (arguments.csv) {
    write_output(*arguments.csv, benchmark::results_csv(results));
  }
}

/// Writes the files every few seconds, so that a process that is killed has lost little.
class Saver {
 public:
  explicit Saver(const SolverArguments& arguments) : arguments_(arguments) {}

  void save(const BenchmarkResults& results) {
    constexpr std::chrono::seconds kEvery(5);
    const auto now = std::chrono::steady_clock::now();
    if (arguments_.json == "-" || arguments_.csv == "-" || now - last_ < kEvery) {
      return;
    }
    last_ = now;
    BenchmarkResults so_far = results;
    so_far.interrupted = true;
    write_files(arguments_, so_far);
  }

 private:
  const SolverArguments& arguments_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

BenchmarkResults measure_all(const SolverArguments& arguments, BenchmarkPlan& plan,
                             SpyPlots* spies) {
  const example::StopsGently gently;
  example::ProgressBar bar;
  Saver saver(arguments);
  plan.on_measured = [&saver](const BenchmarkResults& results) { saver.save(results); };
  plan.on_progress = [&bar](std::size_t done, std::size_t total, const std::string& next) {
    bar.show(done, total, next);
  };
  if (spies != nullptr) {
    plan.on_matrix = [spies](const BenchmarkMatrix& matrix) { spies->add(matrix); };
  }
  return benchmark::run_benchmark(plan);
}

bool nothing_measured(const BenchmarkResults& results) {
  return !results.matrices.empty() && std::all_of(results.matrices.begin(), results.matrices.end(),
                                                  [](const benchmark::MatrixResults& matrix) {
                                                    return !matrix.failure.empty();
                                                  });
}

}  // namespace

ExitCode run_solvers(const SolverArguments& arguments) {
  BenchmarkPlan plan = plan_of(arguments);
  check_outputs(arguments, plan);
  SpyPlots spies;
  const BenchmarkResults results = measure_all(arguments, plan, arguments.plots ? &spies : nullptr);
  write_files(arguments, results);
  if (arguments.json != "-" && arguments.csv != "-") {
    print(benchmark::results_table(results));
  }
  if (arguments.plots) {
    std::vector<Plot> plots = benchmark::benchmark_plots(results);
    plots.insert(plots.end(), spies.plots.begin(), spies.plots.end());
    benchmark::write_plots(plots, *arguments.plots);
  }
  if (results.interrupted) {
    throw ProgramError(ExitCode::kInterrupted,
                       fmt::format("interrupted after {} of {} matrices", results.matrices.size(),
                                   plan.cases.size() + plan.files.size()));
  }
  if (nothing_measured(results)) {
    throw ProgramError(ExitCode::kBadScene, results.matrices.front().failure);
  }
  return ExitCode::kOk;
}

ExitCode run_corpus(const CorpusArguments& arguments) {
  std::vector<Case> cases;
  for (const CorpusSize size : {CorpusSize::kSmall, CorpusSize::kMedium, CorpusSize::kLarge}) {
    if (std::find(arguments.sizes.begin(), arguments.sizes.end(), name_of(size)) !=
        arguments.sizes.end()) {
      const std::vector<Case> own = benchmark::corpus_cases(size, arguments.scenes);
      cases.insert(cases.end(), own.begin(), own.end());
    }
  }
  for (const Case& which : cases) {
    if (!which.scene.empty()) {
      static_cast<void>(scene::read_text_file(which.scene));  // what is missing is said at once
    }
  }
  example::expect_results(arguments.folder, {"matrix.mtx"});
  const example::StopsGently gently;
  example::ProgressBar bar;
  benchmark::CaseAssembler assembler(&stop_flag());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (stop_flag()) {
      throw ProgramError(ExitCode::kInterrupted,
                         fmt::format("interrupted after {} of {} matrices", i, cases.size()));
    }
    bar.show(i, cases.size(), name_of(cases[i]));
    benchmark::write_corpus_matrix(assembler.assemble(cases[i]), arguments.folder);
  }
  print(fmt::format("{} matrices written to {}\n", cases.size(), arguments.folder));
  return ExitCode::kOk;
}

}  // namespace hbar::tool
