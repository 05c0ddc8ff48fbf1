#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Makes a solver of one kind.
using MakeSolver = std::unique_ptr<LinearSolver> (*)(const SolverOptions&);

/// One solver and its uses.
struct SolverEntry {
  std::string name;                   ///< "klu", "cholmod_ldlt", …
  std::string sentence;               ///< what it is, for help texts
  std::string licence;                ///< of the library behind it
  std::string component;              ///< part of hbar: "solvers", "umfpack" or "suite"
  std::string package;                ///< Debian package that building it needs; empty: none
  std::vector<Structure> structures;  ///< those it is meant for
  std::vector<Ordering> orderings;    ///< those it offers, including kDefault
  bool has_64_bit_indices = false;
  MakeSolver make = nullptr;  ///< nullptr: its component is not in this program

  [[nodiscard]] bool claims(Structure structure) const;
  [[nodiscard]] bool offers(Ordering ordering) const;
};

/// Every solver available in this program: block_substitution and klu, and those of the components
/// whose headers it includes (hbar/umfpack.h, hbar/suite.h).
[[nodiscard]] std::vector<SolverEntry> available_solvers();

/// @throws InvalidInput for an unknown name, listing the known ones; for a solver that is not in
///         this program, naming its component and package
[[nodiscard]] const SolverEntry& find_solver(std::string_view name);

/// Adds a component's solver to the program; call it before threads request solvers. The
/// components' headers do so.
///
/// @returns true
/// @throws InvalidInput if the catalogue has no such name
bool register_solver(std::string_view name, MakeSolver make);

}  // namespace hbar::solvers
