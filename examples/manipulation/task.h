#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "examples/common/stretch.h"
#include "hbar/adjoint/programs/transcription.h"

namespace hbar::manipulation {

/// Where a coordinate must be at the end.
struct Goal {
  std::string coordinate;  ///< name, as Model::coordinate_name gives it
  double target = 0.0;     ///< rad or length
  double tolerance = 0.0;  ///< rad or length
  double weight = 0.0;     ///< of ½ ∫ (q − path)² dt
};

/// Controls at a share of the horizon; between two of them the first guess is linear.
struct WayPoint {
  double share = 0.0;        ///< of the horizon, 0 … 1
  Eigen::VectorXd controls;  ///<                                                      [controls]
};

/// A manipulation task: a scene with position motors, its start, its goals, and a first guess that
/// need not reach them.
struct Task {
  std::string name;   ///< of the program
  std::string title;  ///< one line of text
  std::filesystem::path scene;
  double duration = 1.5;  ///< s
  int steps = 300;
  int hold = 10;                                      ///< steps during which a control stays
  std::vector<std::pair<std::string, double>> start;  ///< coordinates with a start other than 0
  std::vector<WayPoint> guess;
  std::vector<Goal> goals;
  double path_begin = 0.1;  ///< share of the horizon at which goal coordinates set out
  double path_end = 0.8;    ///< share of the horizon at which they must have arrived
  std::vector<example::FreeLength> lengths;  ///< of phalanges
  double length_share = 0.3;                 ///< how much shorter or longer they may get, < 1
  double velocity_weight = 0.0;              ///< of ½ ∫ ‖q̇‖² dt: favours slow motions
  double rest_weight = 0.0;                  ///< of ½ ‖q̇‖² at the end
  Eigen::VectorXd control_scale;  ///< typical size of a change                      [controls]
  Eigen::VectorXd control_bound;  ///< |control| ≤                                   [controls]
  /// Relative change of the objective at which five iterations in a row end the last stage.
  double enough = 1e-3;
  std::vector<double> contact_scales = {1.0};  ///< continuation: s of (13), (14), last is 1
  std::vector<std::string> scaled_bodies;      ///< bodies whose s that is
};

/// A task's optimisation: design variables are the lengths, controls are held positions. What is
/// minimised is ½ Σ (changes of controls from block to block, in their scale)², with a small weight
/// on the design's change, subject to the goals.
///
/// @param contact_scale  s of the scaled bodies
/// @param start          where to begin; empty: the first guess                       [x]
/// @throws InvalidInput if the task does not suit its scene
[[nodiscard]] std::unique_ptr<Transcription> make_problem(const Task& task, double contact_scale,
                                                          const Eigen::VectorXd& start = {});

/// |coordinate − target| of each goal at the end.                                       [goals]
[[nodiscard]] Eigen::VectorXd goal_errors(const Task& task, const Model& model,
                                          const TrajectoryValues& values);

}  // namespace hbar::manipulation
