#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace hbar {

/// The three ways to turn a TrajectoryProblem into a nonlinear program. They have the same optima.
enum class Formulation {
  kShooting,          ///< only inputs are variables; the trajectory is simulated from them
  kMultipleShooting,  ///< the horizon in segments, each from a state that is a variable
  kAllAtOnce          ///< every coordinate of every stage is a variable; ḡ = 0 are constraints
};

/// "shooting", "multiple-shooting", "all-at-once".
[[nodiscard]] std::string_view name_of(Formulation formulation);
/// @throws InvalidInput listing the known formulations
[[nodiscard]] Formulation find_formulation(std::string_view name);

/// How to transcribe.
struct TranscriptionOptions {
  Formulation formulation = Formulation::kShooting;
  /// Of kMultipleShooting, as equal as the steps allow. BDF2 restarts in each; to get the same
  /// trajectory from the other formulations, give them
  /// SimulationOptions::restarts = segment_starts(steps, segments).
  int segments = 8;
  int threads = 0;  ///< that evaluate segments; 0: one per core
  /// A first guess of the motion where that is a variable; empty: the motion simulated from the
  /// start values, and rest from where that fails. It begins with the start's q0. [dof x N+1]
  Eigen::MatrixXd q_guess = {};
};

/// The steps at which the segments of kMultipleShooting begin, without the first.
[[nodiscard]] std::vector<int> segment_starts(int steps, int segments);

}  // namespace hbar
