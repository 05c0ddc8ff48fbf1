#pragma once

#include "examples/common/process.h"
#include "solver_arguments.h"

namespace hbar::tool {

/// Measures solvers and shows or writes what was measured, as far as it got.
///
/// Results in files are written on the way, too, every few seconds.
///
/// @throws ProgramError  kUsage for names that are not known, kBadScene if there was nothing to
///   measure, kInterrupted
/// @throws IoError for files that cannot be written, before the work
[[nodiscard]] example::ExitCode run_solvers(const SolverArguments& arguments);

/// Writes a corpus of matrices.
///
/// @throws ProgramError  kInterrupted
/// @throws IoError for files that cannot be written
[[nodiscard]] example::ExitCode run_corpus(const CorpusArguments& arguments);

}  // namespace hbar::tool
