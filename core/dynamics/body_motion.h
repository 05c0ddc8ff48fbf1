#pragma once

#include <vector>

#include "hbar/core/dynamics/motion.h"

namespace hbar {

/// The motion of a body in the world frame, twists at the world's origin.
template <Scalar S>
struct BodyMotion {
  RigidTransform<S> X_WB = {};        ///< body frame in the world
  Vector6<S> V = Vector6<S>::Zero();  ///< twist, zero for the world                [6]
};

/// The motion of a link's body after compute_motion.
///
/// @param link  −1: the world, at rest
template <Scalar S>
[[nodiscard]] inline BodyMotion<S> body_motion(const Model& model, const Mechanism<S>& mechanism,
                                               const Motion<S>& motion, int link) {
  if (link < 0) {
    return {};
  }
  const NodeMotion<S>& joint = motion.at(model.node_of_link(link));
  return {RigidTransform<S>{joint.R, joint.p} * mechanism.X_JB[static_cast<std::size_t>(link)],
          joint.V};
}

/// Covectors on bodies: derivatives of a scalar with respect to displacing a link's body, with its
/// twist carried along, and with respect to its twist alone, both in the world frame.
template <Scalar S>
struct LinkCovectors {
  explicit LinkCovectors(int links)
      : by_displacement(static_cast<std::size_t>(links)),
        by_twist(static_cast<std::size_t>(links)) {}

  std::vector<Vector6<S>> by_displacement;  ///< per link                                   [6]
  std::vector<Vector6<S>> by_twist;         ///< per link                                   [6]
};

}  // namespace hbar
