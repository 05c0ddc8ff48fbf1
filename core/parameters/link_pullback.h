#pragma once

#include "hbar/core/dynamics/body_motion.h"
#include "hbar/core/parameters/applied.h"

namespace hbar {

/// The transpose of kinematics: what covectors on bodies and joint frames make of coordinates, of
/// rates, and of the parameters of frames. Whatever is read off poses and twists is differentiated
/// by it.
///
/// A displacement D of everything below a node changes twists there by more than carries them
/// along: by V_λ × D, λ being what carries the node (formulation §3).
///
/// Sized once, reused: clear, add covectors, sum, then ask. Allocates nothing.
template <Scalar S>
class LinkPullback {
 public:
  explicit LinkPullback(const Model& model);

  /// Forgets all covectors.
  void clear();

  /// Adds covectors on a link's body, as LinkCovectors means them.
  void add_to_body(int link, const Vector6<S>& by_displacement, const Vector6<S>& by_twist);
  /// Adds a covector on displacing a link's joint frame, whatever the body's place in it.
  void add_to_joint(int link, const Vector6<S>& by_displacement);

  /// Sums the covectors along the tree: once, before the following.
  void sum();

  /// by_q += gradient by the coordinates.                                            [dof]
  void add_coordinates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_q) const;
  /// by_qdot += gradient by their rates.                                             [dof]
  void add_rates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_qdot) const;
  /// grad_p += gradient by the set's joint and body transformations.          [set.size()]
  void add_frames(const Applied<S>& applied, const Motion<S>& motion,
                  Eigen::Ref<VectorX<S>> grad_p) const;

 private:
  const Model& model_;
  LinkCovectors<S> bodies_;
  std::vector<Vector6<S>> by_displacement_;  // per node, after sum() of its subtree
  std::vector<Vector6<S>> by_twist_;         // per node, after sum() of its subtree
};

}  // namespace hbar
