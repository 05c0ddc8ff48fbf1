#pragma once

#include "hbar/adjoint/objective.h"
#include "tests/support/random.h"

namespace hbar::testing {

/// Values of a made-up trajectory of 5 steps: 4 coordinates, 6 variables, 2 controls, 3 parameters.
[[nodiscard]] inline TrajectoryValues random_values(unsigned seed) {
  Random random(seed);
  TrajectoryValues values;
  values.h = 0.1;
  values.q = random.matrix(4, 6);
  values.qdot = random.matrix(4, 6);
  values.v = random.matrix(6, 6);
  values.u = random.matrix(2, 5);
  values.p = random.vector(3);
  return values;
}

/// All entries that an objective may depend on.
template <typename T>
[[nodiscard]] Eigen::VectorXd flatten_values(const T& x) {
  Eigen::VectorXd out(x.q.size() + x.qdot.size() + x.v.size() + x.u.size() + x.p.size());
  out << x.q.reshaped(), x.qdot.reshaped(), x.v.reshaped(), x.u.reshaped(), x.p;
  return out;
}

/// The inverse of flatten_values.
[[nodiscard]] inline TrajectoryValues with_values(const Eigen::VectorXd& x,
                                                  const TrajectoryValues& shape) {
  TrajectoryValues out = shape;
  Eigen::Index at = 0;
  for (Eigen::MatrixXd* part : {&out.q, &out.qdot, &out.v, &out.u}) {
    part->reshaped() = x.segment(at, part->size());
    at += part->size();
  }
  out.p = x.tail(out.p.size());
  return out;
}

}  // namespace hbar::testing
