#pragma once

#include <filesystem>
#include <optional>

#include "hbar/adjoint/terms/problem.h"
#include "hbar/core/base/error.h"

namespace hbar {

/// Which design parameters of a scene are free.
enum class ParameterChoice {
  kMask,  ///< those that the links' design_params select
  kAll,
  kNone,
  kNamed  ///< LoadOptions::parameter_names
};

/// An objective that needs no further data.
enum class ObjectiveChoice {
  kVariables,      ///< ½ Σ_{k=1…N} ‖v_k‖²
  kFinalPosition,  ///< ½ ‖q_N‖²
  kTactile         ///< ½ Σ_{k=1…N} ‖tactile_k‖²
};

/// Overrides of what the scene says, and settings that a scene cannot express.
struct LoadOptions {
  std::optional<std::string> integrator;  ///< else the scene's
  std::optional<double> h;                ///< time step, time, > 0; else the scene's
  int steps = 100;                        ///< N ≥ 1
  /// Time to simulate, > 0: as many steps as reach it, in place of `steps`.
  std::optional<double> duration;
  std::optional<double> newton_tol;  ///< on ‖g‖₂, > 0; else the scene's
  /// For the gradient: a name that solver_factory knows, "auto" or "sweep"; else the scene's.
  std::optional<std::string> linear_solver;
  ParameterChoice parameters = ParameterChoice::kMask;
  std::vector<std::string> parameter_names;  ///< as ParameterSet::named; kNamed only
  /// Else kVariables if the scene has an end effector, and kFinalPosition if it has none.
  std::optional<ObjectiveChoice> objective;
  bool keep_factors = true;                 ///< see SimulationOptions
  std::optional<double> max_memory;         ///< see SimulationOptions; else its default
  const std::atomic<bool>* stop = nullptr;  ///< see SimulationOptions; it ends loading, too
};

/// A problem made from a scene file, at nominal inputs: controls and initial state zero.
struct LoadedProblem {
  Problem problem;
  ObjectiveChoice objective;  ///< the one that was taken
  std::string
      linear_solver;  ///< of the gradient: "sweep" is AdjointSweep, others AssembledAdjoint's
  std::vector<std::string> notices;          ///< what the user should know, each `file:line: …`
  std::vector<std::filesystem::path> files;  ///< files read, the scene first; each once
};

/// An option that does not suit the scene, while the scene itself is valid.
class InvalidOption : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Reads a scene file, builds its model and turns it into a problem.
///
/// @throws IoError        if the scene or a file it names cannot be read
/// @throws InvalidInput   if the scene is invalid; the message begins with its file name
/// @throws InvalidOption  if the options are invalid, or do not suit the scene
/// @throws Interrupted    if options.stop is set on the way
[[nodiscard]] LoadedProblem load_problem(const std::filesystem::path& scene,
                                         const LoadOptions& options = {});

}  // namespace hbar
