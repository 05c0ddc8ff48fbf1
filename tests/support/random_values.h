#pragma once

#include "hbar/adjoint/terms/objective.h"
#include "tests/support/random.h"

namespace hbar::testing {

/// Values of a made-up trajectory of 5 steps: 4 coordinates, 6 variables, 2 controls, 3 parameters,
/// 3 readings, 3 measurements declared.
[[nodiscard]] inline TrajectoryValues random_values(unsigned seed) {
  Random random(seed);
  TrajectoryValues values;
  values.h = 0.1;
  values.q = random.matrix(4, 6);
  values.qdot = random.matrix(4, 6);
  values.measured_rows = {6, 3};
  values.measured.resize(12, 6);
  values.v() = random.matrix(6, 6);
  values.u = random.matrix(2, 5);
  values.p = random.vector(3);
  values.tactile() = random.matrix(3, 6);
  values.declared() = random.matrix(3, 6);
  return values;
}

/// All entries that an objective may depend on.
template <typename T>
[[nodiscard]] Eigen::VectorXd flatten_values(const T& x) {
  Eigen::VectorXd out(x.q.size() + x.qdot.size() + x.measured.size() + x.u.size() + x.p.size());
  out << x.q.reshaped(), x.qdot.reshaped(), x.measured.reshaped(), x.u.reshaped(), x.p;
  return out;
}

}  // namespace hbar::testing
