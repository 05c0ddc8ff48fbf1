#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Block substitution if the matrix is block triangular, KLU otherwise; needs no optional
/// component.
[[nodiscard]] SolverFactory default_solver();

/// What a solver needs to know about a matrix besides its pattern.
struct MatrixDescription {
  SolverOptions options;
  std::function<std::string(int)> names;  ///< of the unknowns, for messages
};

/// A solver that is made on first use, and made and analysed again only when the pattern changes.
class CachedSolver {
 public:
  /// @param factory  null means default_solver()
  explicit CachedSolver(SolverFactory factory);

  /// Factorises A.
  ///
  /// @param pattern   the caller's count of patterns so far, > 0; equal numbers mean equal patterns
  /// @param describe  called only when the pattern has changed
  /// @throws what LinearSolver::analyze and factorize throw
  LinearSolver& factorize(const SparseMatrix& A, int pattern,
                          const std::function<MatrixDescription()>& describe);

  /// The solver of the last matrix; there is none before the first factorize().
  [[nodiscard]] LinearSolver& solver() { return *solver_; }
  [[nodiscard]] const LinearSolver& solver() const { return *solver_; }

 private:
  SolverFactory factory_;
  std::unique_ptr<LinearSolver> solver_;
  int pattern_ = 0;
};

}  // namespace hbar::solvers
