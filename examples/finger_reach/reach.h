#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "finger.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/solvers/nlp/ipopt.h"

namespace hbar::finger_reach {

/// Where the tip must be, and when.
struct Target {
  int step = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m [3]
};

/// The co-design problem and what a report needs to know about it.
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

/// What is to be solved, and how it becomes a nonlinear program.
struct ReachOptions {
  int steps = 600;  ///< of the 3 s, a multiple of 60; coarse ones for derivatives: 12, 24, 36, 48
  int blocks = kBlocks;  ///< of constant torque; the last may be shorter
  TranscriptionOptions transcription = {};
  /// BDF2 restarts in each of them, in every formulation; multiple shooting cannot avoid it.
  int segments = 1;
  double effort_weight = 1.0;  ///< of ½ ∫ ‖u‖² dt
  double mass_weight = 0.0;    ///< of the phalanges' mass, per 100 g
  /// If set: kg added to the tip, as a variable fixed by its bounds. It does not count towards the
  /// mass limit.
  std::optional<double> payload = {};
};

/// Sets up the problem: least effort ½ ∫ ‖u‖² dt, with u as fractions of the motors' largest
/// torques.
///
/// @param scene  examples/scenes/finger.xml or one like it
/// @throws IoError, InvalidInput  as read_scene, or if the scene is not such a finger
[[nodiscard]] Reach make_reach(const std::filesystem::path& scene, const ReachOptions& options);

/// Options for Ipopt: solves to 1e-6.
[[nodiscard]] solvers::IpoptOptions ipopt_options(int max_iterations = 200);

/// Distance of the tip to each target, m.                                             [targets]
[[nodiscard]] Eigen::VectorXd tip_errors(const Reach& reach, const TrajectoryValues& values);

}  // namespace hbar::finger_reach
