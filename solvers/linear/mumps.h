#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Sequential MUMPS (CeCILL-C): multifrontal LU, or LDLᵀ where options.structure is kDefinite
/// (hardly pivoting) or kQuasiDefinite; the symmetric ones read the lower triangle alone and tell
/// the inertia. MUMPS cannot be called from two threads: one lock of the process is held during its
/// calls, which does not know of calls that other libraries, Ipopt for one, make to it.
///
/// Orderings: natural, amd, metis; the default is MUMPS' own choice.
///
/// @throws InvalidInput for an ordering that is not among these
[[nodiscard]] std::unique_ptr<LinearSolver> make_mumps(const SolverOptions& options = {});

}  // namespace hbar::solvers
