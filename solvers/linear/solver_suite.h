#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// One solver of the suite and what it is meant for.
struct SolverEntry {
  std::string name;                   ///< "klu", "cholmod_ldlt", …
  std::string sentence;               ///< what it is, for help texts
  std::string licence;                ///< of the library behind it
  std::vector<Structure> structures;  ///< that it is for
  std::vector<Ordering> orderings;    ///< that it offers, kDefault among them
  bool has_64_bit_indices = false;
  std::unique_ptr<LinearSolver> (*make)(const SolverOptions&) = nullptr;

  [[nodiscard]] bool claims(Structure structure) const;
  [[nodiscard]] bool offers(Ordering ordering) const;
};

/// Every solver that this build has, by name.
[[nodiscard]] const std::vector<SolverEntry>& solver_suite();

/// @throws InvalidInput naming the solvers there are, and those that this build was made without
[[nodiscard]] const SolverEntry& find_solver(std::string_view name);

/// What was picked for a matrix, and why.
struct SolverChoice {
  std::string name;
  Ordering ordering = Ordering::kDefault;
  std::string reason;  ///< one sentence
};

/// The solver that should be fastest for a matrix: by its structure, its block sizes and how many
/// entries it has. doc/solvers.md shows the measurements behind it.
[[nodiscard]] SolverChoice choose_solver(const SolverOptions& options, const SparseMatrix& A);

/// A solver by its name, or by choose_solver if the name is "auto".
///
/// @param A  of the pattern that will be analysed; read by "auto" alone
/// @throws InvalidInput for an unknown name, or an ordering, index width or structure (with its
///         block sizes) that the solver does not offer
[[nodiscard]] std::unique_ptr<LinearSolver> make_solver(std::string_view name,
                                                        const SolverOptions& options,
                                                        const SparseMatrix& A);

/// make_solver with its name fixed, for those who make solvers later.
///
/// @throws InvalidInput for an unknown name
[[nodiscard]] SolverFactory solver_factory(std::string_view name,
                                           Ordering ordering = Ordering::kDefault);

}  // namespace hbar::solvers
