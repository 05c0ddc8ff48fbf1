#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace hbar {

/// The three ways to make a nonlinear program of a TrajectoryProblem. They have the same optima.
enum class Formulation {
  kShooting,  ///< inputs alone are variables; the trajectory is what simulation makes of them
  kMultipleShooting,  ///< the horizon in segments, each from a state that is a variable
  kAllAtOnce          ///< every coordinate of every stage is a variable, ḡ = 0 are constraints
};

/// "shooting", "multiple-shooting", "all-at-once".
[[nodiscard]] std::string_view name_of(Formulation formulation);
/// @throws InvalidInput naming the formulations there are
[[nodiscard]] Formulation find_formulation(std::string_view name);

/// How to transcribe.
struct TranscriptionOptions {
  Formulation formulation = Formulation::kShooting;
  /// Of kMultipleShooting, as equal as steps allow. BDF2 starts anew in each: give the others
  /// SimulationOptions::restarts = segment_starts(steps, segments) to have the same trajectory.
  int segments = 8;
  int threads = 0;  ///< that evaluate segments; 0: one per core
  /// A first guess of the motion where that is a variable; empty: what the start simulates, and
  /// where that fails, rest.                                                    [dof x N+1]
  Eigen::MatrixXd q_guess = {};
};

/// The steps at which the segments of kMultipleShooting begin, without the first.
[[nodiscard]] std::vector<int> segment_starts(int steps, int segments);

}  // namespace hbar
