#include "hbar/solvers/linear/cached_solver.h"

#include <utility>

#include "hbar/solvers/linear/block_substitution.h"
#include "hbar/solvers/linear/klu.h"

namespace hbar::solvers {

SolverFactory default_solver() {
  return [](const SolverOptions& options, const SparseMatrix&) -> std::unique_ptr<LinearSolver> {
    if (options.structure == Structure::kBlockTriangular && !options.block_sizes.empty()) {
      return make_block_substitution(options.block_sizes);
    }
    return make_klu(options);
  };
}

CachedSolver::CachedSolver(SolverFactory factory)
    : factory_(factory ? std::move(factory) : default_solver()) {}

LinearSolver& CachedSolver::factorize(const SparseMatrix& A, int pattern,
                                      const std::function<MatrixDescription()>& describe) {
  if (pattern_ != pattern) {
    const MatrixDescription description = describe();
    solver_ = factory_(description.options, A);
    solver_->name_unknowns(description.names);
    solver_->analyze(A);
    pattern_ = pattern;
  }
  solver_->factorize(A);
  return *solver_;
}

}  // namespace hbar::solvers
