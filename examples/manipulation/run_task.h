#pragma once

#include "examples/common/process.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "task.h"

namespace hbar::manipulation {

/// Options for optimising a task; tests do less.
struct TaskOptions {
  int max_iterations = 100;  ///< all stages of the continuation together
  std::function<void(const solvers::IterationInfo&)> on_iteration;  ///< may be empty
  const std::atomic<bool>* stop = nullptr;
  std::filesystem::path solution = {};  ///< where the best point so far goes; empty: nowhere
  double save_every = 10.0;             ///< s; how often
  std::filesystem::path resume = {};    ///< such a file to start from; empty: the first guess
};

/// The result of a task.
struct TaskResult {
  std::unique_ptr<Transcription> problem;  ///< of the last stage
  solvers::IpoptResult last;               ///< of the last stage
  int iterations = 0;                      ///< of all stages
  double start_objective = 0.0;            ///< of the first guess, first stage
  Eigen::VectorXd start_errors;            ///< goal_errors of the first guess, s = 1   [goals]
  Eigen::VectorXd errors;                  ///< goal_errors at the end                  [goals]
  TrajectoryValues values;                 ///< at the end

  /// Whether every goal is met within its tolerance.
  [[nodiscard]] bool reached(const Task& task) const;
};

/// Solves a task with Ipopt (limited-memory BFGS), contact scale by contact scale, each from the
/// last one's result. A stage ends when the optimality error is small, or when five iterations in a
/// row changed the objective by less than task.enough (6 % before the last stage). A file to start
/// from tells its stage, too.
///
/// @throws InvalidInput if the file belongs to another task
[[nodiscard]] TaskResult solve_task(const Task& task, const TaskOptions& options);

/// A program: command line, progress, summary, and result.json, solution.csv, trajectory.csv,
/// iterations.csv.
[[nodiscard]] example::ExitCode run_task(const Task& task, int argc, char** argv);

}  // namespace hbar::manipulation
