#pragma once

#include <string>

#include "walker.h"

namespace hbar::walker {

/// How far two states are apart: the largest difference of a coordinate, and of a rate.
struct StateGap {
  double q = 0.0;     ///< rad or m
  double qdot = 0.0;  ///< rad/s or m/s
};

/// The properties of a gait. All but `lengths`, `weight` and `solution` is of a simulation from the
/// solution's initial state with its controls: a whole gait, the second half with left and right
/// exchanged, N steps each.
struct Gait {
  Eigen::VectorXd lengths;         ///< of thighs and shanks, m                              [2]
  double weight = 0.0;             ///< m g with these lengths, N
  double work = 0.0;               ///< ∫ Σ |P| dt of half a gait, J
  double cost_of_transport = 0.0;  ///< work / (weight advance)
  StateGap solution;               ///< largest gap of the solution's half gait to the simulated one
  StateGap half;                   ///< after N steps, from the start's mirror image
  StateGap whole;                  ///< after 2N steps, from the start
  Eigen::Matrix2Xd load;           ///< normal force on left and right foot, N        [2 x 2N+1]
  double friction_use = 0.0;       ///< largest |tangential| / normal force of a foot that carries
  double slip = 0.0;               ///< how far feet slide in half a gait while they carry, m
};

/// Simulates and evaluates a gait.
///
/// @param values  the solution's half gait: as Transcription::trajectory_values
/// @param lengths  of thighs and shanks                                                 [2]
/// @throws NumericalFailure if it cannot be simulated
[[nodiscard]] Gait examine(const Plan& plan, const TrajectoryProblem& problem,
                           const TrajectoryValues& values, const Eigen::VectorXd& lengths);

/// A foot carries when its load exceeds this share of the weight.
constexpr double kCarries = 0.05;

/// Two lines, a character for each two steps: '#' where a foot carries more than half the weight,
/// '+' while it carries, '.' else.
[[nodiscard]] std::string gait_diagram(const Gait& gait);

}  // namespace hbar::walker
