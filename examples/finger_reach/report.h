#pragma once

#include <string>
#include <vector>

#include "hbar/solvers/ipopt.h"
#include "reach.h"

namespace hbar::finger_reach {

/// What a run leaves behind.
struct Outcome {
  Eigen::VectorXd start;                           ///< x before
  double start_objective = 0.0;                    ///< effort before
  solvers::IpoptResult result;                     ///< x after
  TrajectoryValues values;                         ///< of x after
  std::vector<solvers::IterationInfo> iterations;  ///< one per iterate, the start first
  DesignProblemTimes times;                        ///< without Ipopt's own
};

/// Length of the finger, from the knuckle to the tip, m.
[[nodiscard]] double finger_length(const Reach& reach, const Eigen::VectorXd& x);

/// Mass of the phalanges, kg.
[[nodiscard]] double finger_mass(const Reach& reach, const Eigen::VectorXd& x);

/// The summary for a person to read.
[[nodiscard]] std::string summary(const Reach& reach, const Outcome& outcome);

/// Everything but the trajectory, numbers at full precision.
[[nodiscard]] std::string result_json(const Reach& reach, const Outcome& outcome);

/// A row per step: time, coordinates, rates, tip, and the controls that acted until then.
[[nodiscard]] std::string trajectory_csv(const Reach& reach, const TrajectoryValues& values);

/// A row per iterate.
[[nodiscard]] std::string iterations_csv(const std::vector<solvers::IterationInfo>& iterations);

/// One iterate on one line of at most 80 characters, without a line's end.
[[nodiscard]] std::string progress_line(const solvers::IterationInfo& info);

/// The heading of progress_line's columns.
[[nodiscard]] std::string progress_heading();

}  // namespace hbar::finger_reach
