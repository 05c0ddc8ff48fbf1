#pragma once

#include "hbar/core/dynamics/motion.h"
#include "hbar/core/parameters/applied.h"

namespace hbar {

/// World twists of a frame's six parameters (w, t) at the values w.
template <Scalar S>
struct FrameTwists {
  RigidTransform<S> frame;  ///< world pose of the frame itself
  Matrix3<S> R_parent;      ///< axes that t is measured in
  Matrix3<S> J_w;           ///< right Jacobian at w

  [[nodiscard]] Vector6<S> operator()(int k) const {
    return k < 3 ? rotation_twist<S>(frame, J_w.col(k))
                 : translation_twist<S>(R_parent, Vector3<S>::Unit(k - 3));
  }
};

/// The twists of a joint or body transformation at (q, p).
///
/// @param block  a joint or body transformation of the set
template <Scalar S>
[[nodiscard]] FrameTwists<S> frame_twists(const Model& model, const Applied<S>& applied,
                                          const Motion<S>& motion, const ParameterBlock& block);

/// grad += Σ over the frame's parameters in a block of covector · (world twist of each parameter).
///
/// @param block     a joint or body transformation of the set
/// @param covector  of displacing the frame, world, at its origin                [6]
/// @param grad      gradient with respect to the set's parameters                 [set.size()]
template <Scalar S>
void add_frame_gradient(const Model& model, const Applied<S>& applied, const Motion<S>& motion,
                        const ParameterBlock& block, const Vector6<S>& covector,
                        Eigen::Ref<VectorX<S>> grad);

}  // namespace hbar
