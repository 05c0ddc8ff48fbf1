#include "arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <map>
#include <sstream>

#include "entries.h"
#include "gradient_solver.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/files/numbers.h"
#include "labels.h"
#include "option_values.h"

namespace hbar::tool {
namespace {

struct CommandRow {
  Command command;
  const char* name;
  const char* sentence;
  const char* operand = "SCENE";
  const char* operand_sentence = "Scene file (XML).";
  const char* too_many = "One scene is enough";
};

constexpr std::array<CommandRow, 6> kCommands = {{
    {Command::kInfo, "info",
     "Shows a scene's links, coordinates, motors, variables, contacts, sensors, parameters."},
    {Command::kSimulate, "simulate", "Simulates a scene and shows or writes the trajectory."},
    {Command::kGradient, "gradient", "Simulates a scene and differentiates an objective of it."},
    {Command::kCheck, "check", "Compares the gradient with finite differences, class by class."},
    {Command::kSolvers, "solvers",
     "Measures linear solvers on systems of scenes, of generated models or of files.", "SCENE...",
     "Scene files (XML); without any, generated models.", ""},
    {Command::kCorpus, "corpus", "Writes such systems as Matrix Market files.", "DIR",
     "Folder for the files; it is made if it is not there.", "One folder is enough"},
}};

/// Which commands have an option: one bit per command.
enum : unsigned {
  kInInfo = 1,
  kInSimulate = 2,
  kInGradient = 4,
  kInCheck = 8,
  kInSolvers = 16,
  kInCorpus = 32
};
constexpr unsigned kInRuns = kInSimulate | kInGradient | kInCheck;

struct OptionRow {
  const char* name;
  const char* value;
  unsigned commands;
  const char* sentence;
};

constexpr std::array<OptionRow, 31> kOptions = {{
    {"--steps", "N", kInRuns, "Number of time steps (100)."},
    {"--time", "T", kInRuns, "Time to simulate in seconds, in place of --steps."},
    {"--dt", "H", kInRuns, "Time step in seconds (the scene's)."},
    {"--integrator", "NAME", kInRuns, "bdf1, bdf2 or sdirk2 (the scene's)."},
    {"--q0", "LIST", kInRuns, "Initial coordinates, rad or length (zeros)."},
    {"--qdot0", "LIST", kInRuns, "Initial rates of the coordinates (zeros)."},
    {"--from", "CSV:ROW", kInRuns,
     "Initial coordinates and rates from a row of a table that --csv wrote; 0 is its first row, -1 "
     "and none its last."},
    {"--controls", "FILE", kInRuns, "Controls: a row per step, a column per control (zeros)."},
    {"--params", "SET", kInInfo | kInRuns,
     "Design parameters: mask (the scene's design_params), all, none, or a list of names (mask)."},
    {"--objective", "NAME", kInRuns,
     "variables: half the sum of squared variables of all steps; final-position: half the squared "
     "last q; tactile: half the sum of squared sensor readings of all steps (variables where there "
     "are any, else final-position)."},
    {"--newton-tol", "X", kInRuns, "Newton's bound on the residual's norm (the scene's)."},
    {"--linear-solver", "NAME", kInGradient,
     "What solves the gradient's linear system: sweep, auto or a solver's name (the scene's)."},
    {"--out", "FILE", kInRuns, "Writes the results as JSON; - is standard output."},
    {"--csv", "FILE", kInSimulate | kInGradient,
     "Writes q, qdot, variables and sensor readings of every step as CSV; - is standard output."},
    {"--family", "LIST", kInSolvers,
     "Generated models: chain, tree, hand (all, if neither a scene nor --matrices is given)."},
    {"--dof", "LIST", kInSolvers, "Their numbers of joints; a hand's ball has 6 more (7)."},
    {"--steps", "LIST", kInSolvers, "Numbers of time steps (50)."},
    {"--integrator", "LIST", kInSolvers, "bdf1, bdf2, sdirk2 (bdf2)."},
    {"--system", "LIST", kInSolvers, "adjoint, periodic, gauss_newton, kkt (all)."},
    {"--solver", "LIST", kInSolvers,
     "auto, and names of solvers (all: auto and, for each matrix, every one meant for it)."},
    {"--ordering", "LIST", kInSolvers,
     "default, natural, amd, colamd, metis, nested; solvers that do not offer one are left out "
     "(default)."},
    {"--clock", "NAME", kInSolvers, "wall, or cpu: steadier on a machine that is shared (wall)."},
    {"--rhs", "N", kInSolvers, "Right-hand sides that are solved at once (16)."},
    {"--repeat", "N", kInSolvers, "The fastest of so many runs counts (3)."},
    {"--matrices", "DIR", kInSolvers, "Measures on the Matrix Market files in a folder, too."},
    {"--structure", "NAME", kInSolvers,
     "What these matrices are: general, block_triangular, periodic, definite or quasi_definite "
     "(what the JSON file beside each says, else definite or general)."},
    {"--json", "FILE", kInSolvers, "Writes the results as JSON; - is standard output."},
    {"--csv", "FILE", kInSolvers, "Writes a row per measurement as CSV; - is standard output."},
    {"--plots", "DIR", kInSolvers, "Draws figures (SVG) with gnuplot, in a folder."},
    {"--size", "LIST", kInCorpus, "small, medium, large or all (small)."},
    {"--scenes", "DIR", kInCorpus,
     "Folder of the examples' scenes (that of the source the command was built from)."},
}};

/// Of a simulation; memory sets a lower limit, which depends on the scene.
constexpr int kMostSteps = 1'000'000'000;

std::optional<std::string> integrator(const Given& given) {
  const std::optional<std::string> text = value_of(given, "--integrator");
  if (text) {
    check_name("--integrator", *text, integrator_names());
  }
  return text;
}

std::optional<ObjectiveChoice> objective(const Given& given) {
  const std::optional<std::string> text = value_of(given, "--objective");
  if (!text) {
    return std::nullopt;
  }
  const std::vector<std::string>& names = objective_names();
  check_name("--objective", *text, names);
  const auto place = std::find(names.begin(), names.end(), *text);
  return static_cast<ObjectiveChoice>(place - names.begin());
}

void read_parameters(const Given& given, LoadOptions& load) {
  const std::string text = value_of(given, "--params").value_or("mask");
  if (text == "mask" || text == "all" || text == "none") {
    load.parameters = text == "mask"  ? ParameterChoice::kMask
                      : text == "all" ? ParameterChoice::kAll
                                      : ParameterChoice::kNone;
    return;
  }
  std::string reason;
  const std::vector<std::string_view> names = split_entries(text, reason);
  if (names.empty()) {
    usage(fmt::format("--params: {}; give mask, all, none or names",
                      reason.empty() ? "it is empty" : reason));
  }
  load.parameters = ParameterChoice::kNamed;
  load.parameter_names.assign(names.begin(), names.end());
}

Arguments read(Command command, std::string scene, const Given& given) {
  Arguments out;
  out.command = command;
  out.scene = std::move(scene);
  out.load.steps = count(given, "--steps", kMostSteps).value_or(out.load.steps);
  if (command == Command::kInfo) {  // nothing is simulated: a model of any size may be looked at
    out.load.steps = 1;
    out.load.max_memory = std::numeric_limits<double>::infinity();
  }
  out.load.keep_factors = command == Command::kGradient || command == Command::kCheck;
  out.load.duration = positive_number(given, "--time");
  if (out.load.duration && given.contains("--steps")) {
    usage("--time and --steps both say how long to simulate; give one of them");
  }
  out.load.h = positive_number(given, "--dt");
  out.load.integrator = integrator(given);
  out.load.newton_tol = positive_number(given, "--newton-tol");
  out.load.linear_solver = value_of(given, "--linear-solver");
  if (out.load.linear_solver) {
    check_name("--linear-solver", *out.load.linear_solver, linear_solver_names());
  }
  out.load.objective = objective(given);
  read_parameters(given, out.load);
  out.q0 = numbers(given, "--q0");
  out.qdot0 = numbers(given, "--qdot0");
  out.from = file(given, "--from");
  if (out.from && (out.q0 || out.qdot0)) {
    usage("--from gives the initial state; leave out --q0 and --qdot0");
  }
  out.controls = file(given, "--controls");
  out.out = file(given, "--out");
  out.csv = file(given, "--csv");
  if (out.out == "-" && out.csv == "-") {
    usage("--out and --csv cannot both go to standard output");
  }
  return out;
}

/// What CLI11 could not place, in this command's words.
[[noreturn]] void explain(const CLI::App& command, const std::vector<std::string>& names,
                          const char* too_many, const CLI::ParseError& error) {
  const std::string help = fmt::format(" (see: hbar {} --help)", command.get_name());
  for (const std::string& word : command.remaining()) {
    if (word.starts_with("-")) {
      const std::string name = word.substr(0, word.find('='));
      usage(fmt::format("{}: there is no option {}; {}{}", command.get_name(),
                        scene::quotable(name), unknown_name_hint(name, names), help));
    }
    usage(fmt::format("{}: what is \"{}\" for? {}{}", command.get_name(), scene::quotable(word),
                      too_many, help));
  }
  usage(fmt::format("{}: {}{}", command.get_name(), error.what(), help));
}

void check_command_name(int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CommandRow& row : kCommands) {
    names.emplace_back(row.name);
  }
  if (argc < 2) {
    usage(fmt::format("a command is needed: {} (see: hbar --help)", fmt::join(names, ", ")));
  }
  const std::string name = argv[1];
  if (name == "--help" || name == "-h" || name == "--version") {
    return;
  }
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    usage(fmt::format("there is no command \"{}\"; {} (see: hbar --help)", scene::quotable(name),
                      unknown_name_hint(name, names)));
  }
}

}  // namespace

CommandLine parse_arguments(int argc, const char* const* argv) {
  check_command_name(argc, argv);
  CLI::App app("Differentiable simulation of articulated rigid bodies.", "hbar");
  app.set_version_flag("--version", "hbar " HBAR_VERSION);
  app.footer("Lists are numbers or names separated by blanks or commas. Each command has --help.");
  std::vector<std::string> scenes;
  std::string operand;
  std::array<std::map<std::string, std::string>, kCommands.size()> values;
  std::array<CLI::App*, kCommands.size()> commands = {};
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    const CommandRow& row = kCommands[i];
    commands[i] = app.add_subcommand(row.name, row.sentence);
    if (row.command == Command::kSolvers) {
      commands[i]->add_option(row.operand, scenes, row.operand_sentence)->type_name("");
    } else {
      commands[i]
          ->add_option(row.operand, operand, row.operand_sentence)
          ->required()
          ->type_name("");
    }
    for (const OptionRow& option : kOptions) {
      if ((option.commands & (1U << i)) != 0U) {
        commands[i]
            ->add_option(option.name, values[i][option.name], option.sentence)
            ->type_name(option.value);
      }
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wish) {
    std::ostringstream text;
    app.exit(wish, text, text);
    return text.str();
  } catch (const CLI::ParseError& error) {
    for (std::size_t i = 0; i < kCommands.size(); ++i) {
      std::vector<std::string> names;
      for (const auto& [name, value] : values[i]) {
        names.push_back(name);
      }
      if (commands[i]->parsed() || std::string_view(argv[1]) == kCommands[i].name) {
        explain(*commands[i], names, kCommands[i].too_many, error);
      }
    }
    usage(error.what());
  }
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    if (commands[i]->parsed()) {
      Given given;
      for (const auto& [name, value] : values[i]) {
        if (commands[i]->count(name) > 0) {
          given.emplace(name, value);
        }
      }
      switch (kCommands[i].command) {
        case Command::kSolvers:
          return read_solver_arguments(scenes, given);
        case Command::kCorpus:
          return read_corpus_arguments(operand, given);
        default:
          return read(kCommands[i].command, operand, given);
      }
    }
  }
  usage("a command is needed (see: hbar --help)");
}

}  // namespace hbar::tool
