#include "solver_arguments.h"

#include <algorithm>

#include "hbar/adjoint/systems/trajectory_system.h"

namespace hbar::tool {
namespace {

const std::vector<std::string> kSizes = {"small", "medium", "large", "all"};

// Systems larger than these take more than the memory or the patience of a measurement: a matrix of
// the generated models has joints² entries per step, and each of them is factorised `repeat` times.
constexpr int kMostJoints = 10'000;
constexpr int kMostSystemSteps = 1'000'000;
constexpr int kMostRhs = 10'000;
constexpr int kMostRepeats = 10'000;

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const SystemKind kind :
       {SystemKind::kAdjoint, SystemKind::kPeriodic, SystemKind::kGaussNewton, SystemKind::kKkt}) {
    names.emplace_back(name_of(kind));
  }
  return names;
}

/// A list of names that must be among those known; "all" stands for all of them.
std::vector<std::string> known_words(const Given& given, const std::string& option,
                                     const std::vector<std::string>& known,
                                     const std::vector<std::string>& without) {
  const std::vector<std::string> list = words(given, option).value_or(without);
  if (list == std::vector<std::string>{"all"}) {
    return known;
  }
  for (const std::string& name : list) {
    check_name(option, name, known);
  }
  return list;
}

}  // namespace

SolverArguments read_solver_arguments(const std::vector<std::string>& scenes, const Given& given) {
  SolverArguments out;
  out.scenes = scenes;
  out.matrices = file(given, "--matrices");
  // What is named is measured, and the families where nothing is.
  const bool named = !scenes.empty() || out.matrices;
  out.families =
      words(given, "--family")
          .value_or(named ? std::vector<std::string>() : std::vector<std::string>{"all"});
  out.joints = counts(given, "--dof", kMostJoints).value_or(std::vector{7});
  out.steps = counts(given, "--steps", kMostSystemSteps).value_or(std::vector{50});
  out.integrators = known_words(given, "--integrator", integrator_names(), {"bdf2"});
  out.systems = known_words(given, "--system", system_names(), system_names());
  out.solvers = words(given, "--solver").value_or(std::vector<std::string>{"all"});
  if (out.solvers == std::vector<std::string>{"all"}) {
    out.solvers.clear();
  }
  out.orderings = words(given, "--ordering").value_or(std::vector<std::string>{"default"});
  out.clock = value_of(given, "--clock").value_or(out.clock);
  check_name("--clock", out.clock, {"wall", "cpu"});
  out.rhs = count(given, "--rhs", kMostRhs).value_or(out.rhs);
  out.repeat = count(given, "--repeat", kMostRepeats).value_or(out.repeat);
  out.structure = value_of(given, "--structure").value_or("");
  if (!out.structure.empty() && !out.matrices) {
    usage("--structure says what the matrices of --matrices are; name their folder");
  }
  out.json = file(given, "--json");
  out.csv = file(given, "--csv");
  out.plots = file(given, "--plots");
  if (out.json == "-" && out.csv == "-") {
    usage("--json and --csv cannot both go to standard output");
  }
  return out;
}

CorpusArguments read_corpus_arguments(const std::string& folder, const Given& given) {
  CorpusArguments out;
  out.folder = folder;
  if (folder.empty()) {
    usage("corpus: the folder has no name");
  }
  out.scenes = file(given, "--scenes").value_or(HBAR_SOURCE_DIR "/examples/scenes");
  out.sizes = words(given, "--size").value_or(std::vector<std::string>{"small"});
  for (const std::string& size : out.sizes) {
    check_name("--size", size, kSizes);
  }
  if (std::find(out.sizes.begin(), out.sizes.end(), "all") != out.sizes.end()) {
    out.sizes = {"small", "medium", "large"};
  }
  return out;
}

}  // namespace hbar::tool
