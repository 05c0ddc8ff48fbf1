#pragma once

#include <memory>

#include "hbar/adjoint/programs/formulation.h"
#include "hbar/adjoint/programs/transcription.h"

namespace hbar {

/// Turns a problem into a nonlinear program, which keeps its own copy of the problem.
///
/// @throws InvalidInput if the problem's parts or the options do not fit together: sizes, places
///         outside the trajectory, more segments than steps
[[nodiscard]] std::unique_ptr<Transcription> transcribe(const TrajectoryProblem& problem,
                                                        const TranscriptionOptions& options = {});

}  // namespace hbar
