#pragma once

#include <memory>

#include "hbar/adjoint/programs/formulation.h"
#include "hbar/adjoint/programs/transcription.h"

namespace hbar {

/// Makes a nonlinear program of a problem, of which it keeps a copy of its own.
///
/// @throws InvalidInput if the problem's parts or the options do not fit together: sizes, places
///         beyond the trajectory, more segments than steps
[[nodiscard]] std::unique_ptr<Transcription> transcribe(const TrajectoryProblem& problem,
                                                        const TranscriptionOptions& options = {});

}  // namespace hbar
