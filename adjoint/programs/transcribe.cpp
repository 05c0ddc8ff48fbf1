#include "hbar/adjoint/programs/transcribe.h"

#include "hbar/adjoint/programs/all_at_once.h"
#include "hbar/adjoint/programs/shooting.h"

namespace hbar {

std::unique_ptr<Transcription> transcribe(const TrajectoryProblem& problem,
                                          const TranscriptionOptions& options) {
  if (options.formulation == Formulation::kAllAtOnce) {
    return std::make_unique<AllAtOnce>(problem, options);
  }
  return std::make_unique<Shooting>(problem, options);
}

}  // namespace hbar
