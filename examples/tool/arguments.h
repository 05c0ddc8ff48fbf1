#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hbar/adjoint/programs/load_problem.h"
#include "solver_arguments.h"

namespace hbar::tool {

/// What to do. The first four take a scene and have Arguments.
enum class Command { kInfo, kSimulate, kGradient, kCheck, kSolvers, kCorpus };

/// The command line as parsed. Sizes are not checked: the scene is not read yet.
struct Arguments {
  Command command = Command::kInfo;
  std::string scene;  ///< a file
  LoadOptions load;
  std::optional<std::vector<double>> q0;     ///< rad or length; else zeros      [dof]
  std::optional<std::vector<double>> qdot0;  ///< else zeros                     [dof]
  std::optional<std::string> from;           ///< a file and perhaps a row: --from; else q0, qdot0
  std::optional<std::string> controls;       ///< a file; else zeros
  std::optional<std::string> out;            ///< JSON file; "-" is standard output
  std::optional<std::string> csv;            ///< CSV file; "-" is standard output
};

/// What a command line says, or a text to print (help, version).
using CommandLine = std::variant<Arguments, SolverArguments, CorpusArguments, std::string>;

/// Reads the command line.
/// @throws ProgramError (kUsage) naming the option, what was found and what is allowed
[[nodiscard]] CommandLine parse_arguments(int argc, const char* const* argv);

}  // namespace hbar::tool
