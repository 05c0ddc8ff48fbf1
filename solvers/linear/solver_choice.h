#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// The solver chosen for a matrix, and why.
struct SolverChoice {
  std::string name;
  Ordering ordering = Ordering::kDefault;
  std::string reason;  ///< one sentence
};

/// The solver expected to be fastest for a matrix among those in the program, judged by structure,
/// block sizes and number of entries. doc/solvers.md has the measurements behind it.
[[nodiscard]] SolverChoice choose_solver(const SolverOptions& options, const SparseMatrix& A);

/// A solver by its name, or by choose_solver if the name is "auto".
///
/// @param A  of the pattern that will be analysed; read only by "auto"
/// @throws InvalidInput as find_solver, or for an ordering, index width or structure (with its
///         block sizes) that the solver does not offer
[[nodiscard]] std::unique_ptr<LinearSolver> make_solver(std::string_view name,
                                                        const SolverOptions& options,
                                                        const SparseMatrix& A);

/// make_solver with a fixed name, for code that creates solvers later.
///
/// @throws InvalidInput as find_solver
[[nodiscard]] SolverFactory solver_factory(std::string_view name,
                                           Ordering ordering = Ordering::kDefault);

}  // namespace hbar::solvers
