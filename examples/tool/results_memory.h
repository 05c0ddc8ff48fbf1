#pragma once

#include "arguments.h"
#include "hbar/adjoint/programs/load_problem.h"

namespace hbar::tool {

/// What a command holds at its peak, bytes: what the library takes (memory_estimate.h), the results
/// beside it, and then the files' text with what it is made from.
[[nodiscard]] double estimate_run(const Arguments& arguments, const LoadedProblem& loaded);

/// @throws ProgramError (kUsage) if a command would take more than SimulationOptions::max_memory
void require_memory(const Arguments& arguments, const LoadedProblem& loaded);

}  // namespace hbar::tool
