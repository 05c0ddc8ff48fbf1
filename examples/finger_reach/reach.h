#pragma once

#include <filesystem>
#include <memory>

#include "finger.h"
#include "hbar/adjoint/transcription.h"
#include "hbar/solvers/ipopt.h"

namespace hbar::finger_reach {

/// Where the tip has to be, and when.
struct Target {
  int step = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m [3]
};

/// The co-design problem and what a report needs to know of it.
struct Reach {
  std::array<Phalanx, 3> phalanges;
  std::vector<Target> targets;
  std::unique_ptr<Transcription> problem;
};

constexpr double kDuration = 3.0;      ///< s
constexpr double kHalfWidth = 5e-4;    ///< of the box around a target, m
constexpr double kMassLimit = 0.12;    ///< of phalanges and tip, kg
constexpr double kRatio = 8.0;         ///< longest phalanx per width
constexpr int kBlocks = 30;            ///< of constant torque
constexpr int kLimitSamples = 60;      ///< times at which joint limits are looked at
constexpr double kLimitMargin = 0.01;  ///< for what happens in between, rad

/// Sets up the problem: least effort ½ ∫ ‖u‖² dt, u being shares of the motors' greatest torques.
///
/// @param scene  examples/scenes/finger.xml or one like it
/// @param steps  of the 3 s, a multiple of 60
/// @throws IoError, InvalidInput  as read_scene, or if the scene is no such finger
[[nodiscard]] Reach make_reach(const std::filesystem::path& scene, int steps);

/// How Ipopt is asked to solve it.
[[nodiscard]] solvers::IpoptOptions ipopt_options(int max_iterations);

/// Distance of the tip to each target, m.                                             [targets]
[[nodiscard]] Eigen::VectorXd tip_errors(const Reach& reach, const TrajectoryValues& values);

}  // namespace hbar::finger_reach
