#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "examples/common/stretch.h"
#include "hbar/adjoint/programs/transcription.h"
#include "hbar/solvers/nlp/ipopt.h"

namespace hbar::walker {

/// The kind of gait to find.
struct Plan {
  std::filesystem::path scene;  ///< examples/scenes/walker.xml or one like it
  int steps = 50;               ///< N, of half a gait: from one touch-down to the other leg's
  double duration = 0.5;        ///< of half a gait, s
  double speed = 1.0;           ///< average, m/s
  int blocks = 25;              ///< of controls that are held
  double double_support = 0.1;  ///< share of half a gait during which both feet touch
  double clearance = 0.03;      ///< of the swinging foot in the middle of its swing, m
  /// Lengths of thigh and shank to begin with, m; empty: the scene's.
  std::vector<double> begin = {};
  double length_share = 0.25;  ///< how much shorter or longer thighs and shanks may get; 0: held
  /// Steps at which BDF2 restarts when a solution is simulated, as it does between the segments of
  /// multiple shooting.
  std::vector<int> restarts = {};

  /// The distance covered by half a gait, m.
  [[nodiscard]] double advance() const { return speed * duration; }
  /// Steps during which a control stays.
  [[nodiscard]] int hold() const { return std::max(1, steps / blocks); }
  /// The step after which the right foot takes off.
  [[nodiscard]] int take_off() const {
    return static_cast<int>(std::lround(double_support * steps));
  }
};

/// The objective.
enum class Aim {
  kFollowGuess,     ///< distance from the first guess: some gait
  kSmoothedCost,    ///< as below, with corners rounded widely and more weight on smooth torques
  kCostOfTransport  ///< work of the motors per weight and distance
};

/// Of the thighs and of the shanks: the same for both legs.
[[nodiscard]] std::vector<example::FreeLength> leg_lengths();

/// The coordinate that each coordinate is mirrored to: left_… and right_… change places. [dof]
/// @throws InvalidInput if a coordinate has no counterpart
[[nodiscard]] std::vector<int> mirror(const Model& model);

/// The end is the mirror image of the start, `advance` farther along the first coordinate:
/// q_N[mirror] − q_0 = (advance, 0, …) and q̇_N[mirror] − q̇_0 = 0.
[[nodiscard]] ConstraintPointer mirrored_periodicity(const Model& model, int steps, double advance);

/// A walking-like motion that obeys no dynamics: the hip moves evenly, the left foot stands, the
/// right foot swings on a sine.                                                  [dof x N+1]
[[nodiscard]] Eigen::MatrixXd first_guess(const Plan& plan, const Model& model);

/// Half a gait as a problem: lengths, held torques and the initial state are free; the end is the
/// mirror image of the start; joints stay within their limits; the left foot touches throughout,
/// and the right one for plan.take_off() steps, after which it stays above its clearance.
///
/// @throws IoError, InvalidInput  as read_scene, or if the scene is not such a walker
[[nodiscard]] TrajectoryProblem walker_problem(const Plan& plan, Aim aim);

/// Options for Ipopt.
///
/// @param earlier  the result for the aim before this one, where to begin; may be null
[[nodiscard]] solvers::IpoptOptions ipopt_options(Aim aim, const solvers::IpoptResult* earlier);

/// The model's weight at the scene's lengths, m g.
[[nodiscard]] double nominal_weight(const Model& model);

}  // namespace hbar::walker
