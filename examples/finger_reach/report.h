#pragma once

#include <string>
#include <vector>

#include "examples/common/optimise.h"
#include "reach.h"

namespace hbar::finger_reach {

/// The result of a run.
struct Outcome {
  Eigen::VectorXd start;         ///< x before
  double start_objective = 0.0;  ///< effort before
  example::Optimised optimised;  ///< x after, the iterates and where the time went
  TrajectoryValues values;       ///< of x after
};

/// Length of the finger, from the knuckle to the tip, m.
[[nodiscard]] double finger_length(const Reach& reach, const Eigen::VectorXd& x);

/// Mass of the phalanges, kg.
[[nodiscard]] double finger_mass(const Reach& reach, const Eigen::VectorXd& x);

/// A readable summary.
[[nodiscard]] std::string summary(const Reach& reach, const Outcome& outcome);

/// Everything but the trajectory, numbers at full precision.
[[nodiscard]] std::string result_json(const Reach& reach, const Outcome& outcome);

}  // namespace hbar::finger_reach
