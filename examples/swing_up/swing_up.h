#pragma once

#include <filesystem>
#include <memory>

#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/solvers/nlp/ipopt.h"

namespace hbar::swing_up {

constexpr double kDuration = 3.0;      ///< s
constexpr double kSmoothness = 1e-3;   ///< weight of the control's rate, s²
constexpr double kTrackMargin = 0.05;  ///< how far the cart stays inside the track's ends, m

/// A cart with two rods swings them up: from rest, hanging, to rest, upright, at the track's
/// middle. The objective is ½ ∫ u² + 1e-3 u̇² dt with u as a fraction of the motor's largest force.
struct SwingUp {
  TrajectoryProblem problem;
  Eigen::MatrixXd q_guess;  ///< a straight line from hanging to upright             [dof x N+1]
};

/// @param scene  examples/scenes/swing_up.xml or one like it
/// @param steps  N > 0 of the 3 s, each with its own control
/// @throws IoError, InvalidInput  as read_scene, or if the scene is not a cart with two rods
[[nodiscard]] SwingUp make_swing_up(const std::filesystem::path& scene, int steps);

/// The nonlinear program. States begin on the straight line where they are variables.
///
/// @param options  its q_guess is set here
[[nodiscard]] std::unique_ptr<Transcription> transcribe_swing_up(const SwingUp& swing_up,
                                                                 TranscriptionOptions options);

/// Options for Ipopt: solves to 1e-8.
[[nodiscard]] solvers::IpoptOptions ipopt_options();

/// The same with the barrier parameter held at `mu` throughout: Ipopt then is Newton's method on
/// one system of equations, and with exact second derivatives its last steps converge
/// quadratically. The solution is the barrier problem's, not quite the problem's own.
[[nodiscard]] solvers::IpoptOptions fixed_barrier_options(double mu);

/// How far the end of a motion is from upright and at rest: the largest of the errors of q_N in rad
/// or m and of q̇_N per s.
[[nodiscard]] double upright_error(const TrajectoryValues& values);

}  // namespace hbar::swing_up
