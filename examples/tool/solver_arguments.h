#pragma once

#include <optional>
#include <string>
#include <vector>

#include "option_values.h"

namespace hbar::tool {

/// What the command line of `hbar solvers` says. Names of families, solvers and orderings are not
/// checked: which there are depends on the build.
struct SolverArguments {
  std::vector<std::string> scenes;    ///< files
  std::vector<std::string> families;  ///< of generated models; {"all"}: all
  std::vector<int> joints;            ///< of generated models
  std::vector<int> steps;
  std::vector<std::string> integrators;
  std::vector<std::string> systems;
  std::vector<std::string> solvers;  ///< empty: all
  std::vector<std::string> orderings;
  std::string clock = "wall";  ///< or "cpu"
  int rhs = 16;
  int repeat = 3;
  std::optional<std::string> matrices;  ///< folder of Matrix Market files
  std::string structure;                ///< of all of them; empty: of each its own
  std::optional<std::string> json;      ///< file; "-" is standard output
  std::optional<std::string> csv;       ///< file; "-" is standard output
  std::optional<std::string> plots;     ///< folder
};

/// What the command line of `hbar corpus` says.
struct CorpusArguments {
  std::string folder;
  std::string scenes;  ///< folder of the examples' scenes
  std::vector<std::string> sizes;
};

/// @throws ProgramError (kUsage) naming the option, what was found and what is allowed
[[nodiscard]] SolverArguments read_solver_arguments(const std::vector<std::string>& scenes,
                                                    const Given& given);

/// @throws ProgramError (kUsage) as read_solver_arguments
[[nodiscard]] CorpusArguments read_corpus_arguments(const std::string& folder, const Given& given);

}  // namespace hbar::tool
