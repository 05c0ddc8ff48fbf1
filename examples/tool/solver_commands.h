#pragma once

#include "process.h"
#include "solver_arguments.h"

namespace hbar::tool {

/// Measures solvers and shows or writes what was measured, as far as it got.
///
/// @throws ToolError  kUsage for names that are not known, kBadScene if there was nothing to
///                    measure, kInputOutput for files, kInterrupted
[[nodiscard]] ExitCode run_solvers(const SolverArguments& arguments);

/// Writes a corpus of matrices.
///
/// @throws ToolError  kUsage without CHOLMOD, kInputOutput for files, kInterrupted
[[nodiscard]] ExitCode run_corpus(const CorpusArguments& arguments);

}  // namespace hbar::tool
