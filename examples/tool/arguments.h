#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hbar/adjoint/load_problem.h"

namespace hbar::tool {

/// What to do with a scene.
enum class Command { kInfo, kSimulate, kGradient, kCheck };

/// What the command line says. Sizes are not checked: the scene is not read yet.
struct Arguments {
  Command command = Command::kInfo;
  std::string scene;  ///< a file
  LoadOptions load;
  std::optional<std::vector<double>> q0;     ///< rad or length; else zeros      [dof]
  std::optional<std::vector<double>> qdot0;  ///< else zeros                     [dof]
  std::optional<std::string> controls;       ///< a file; else zeros
  std::optional<std::string> out;            ///< JSON file; "-" is standard output
  std::optional<std::string> csv;            ///< CSV file; "-" is standard output
};

/// Reads the command line.
///
/// @returns  what it says, or a text to print (help, version)
/// @throws ToolError (kUsage) naming the option, what was found and what is allowed
[[nodiscard]] std::variant<Arguments, std::string> parse_arguments(int argc,
                                                                   const char* const* argv);

}  // namespace hbar::tool
