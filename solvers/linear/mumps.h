#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Sequential MUMPS (CeCILL-C): multifrontal LU, or LDLᵀ if options.structure is kDefinite (hardly
/// pivoting) or kQuasiDefinite; the symmetric ones read only the lower triangle and give the
/// inertia. MUMPS cannot be called from two threads: a process-wide lock is held during its calls,
/// which does not cover calls from other libraries such as Ipopt.
///
/// Orderings: natural, amd, metis; the default is MUMPS's own choice.
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_mumps(const SolverOptions& options = {});

}  // namespace hbar::solvers
