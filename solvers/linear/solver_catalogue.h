#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Makes a solver of one kind.
using MakeSolver = std::unique_ptr<LinearSolver> (*)(const SolverOptions&);

/// One solver and what it is meant for.
struct SolverEntry {
  std::string name;                   ///< "klu", "cholmod_ldlt", …
  std::string sentence;               ///< what it is, for help texts
  std::string licence;                ///< of the library behind it
  std::string component;              ///< of hbar that it is in: "solvers", "umfpack" or "suite"
  std::string package;                ///< of Debian that hbar's build needs for it; empty: none
  std::vector<Structure> structures;  ///< that it is for
  std::vector<Ordering> orderings;    ///< that it offers, kDefault among them
  bool has_64_bit_indices = false;
  MakeSolver make = nullptr;  ///< nullptr: its component is not in this program

  [[nodiscard]] bool claims(Structure structure) const;
  [[nodiscard]] bool offers(Ordering ordering) const;
};

/// Every solver that this program has: block_substitution and klu, and those of the components
/// whose headers it includes (hbar/umfpack.h, hbar/suite.h).
[[nodiscard]] std::vector<SolverEntry> available_solvers();

/// @throws InvalidInput for a name that no solver has, with the names that there are; for a solver
///         that is not in this program, with its component and package
[[nodiscard]] const SolverEntry& find_solver(std::string_view name);

/// Adds a solver of a component to the program; to be called before threads ask for solvers. The
/// components' headers do so.
///
/// @returns true
/// @throws InvalidInput if the catalogue has no such name
bool register_solver(std::string_view name, MakeSolver make);

}  // namespace hbar::solvers
