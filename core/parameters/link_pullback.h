#pragma once

#include "hbar/core/dynamics/body_motion.h"
#include "hbar/core/parameters/applied.h"

namespace hbar {

/// The transpose of kinematics: maps covectors on bodies and joint frames to gradients with respect
/// to coordinates, rates and frame parameters. Differentiates anything that is read from poses and
/// twists.
///
/// A displacement D of everything below a node not only carries the twists there along but also
/// changes them by V_λ × D, where λ is the parent of the node (doc/notation.md, "Columns").
///
/// Sized once, reused: clear, add covectors, sum, then read results. Allocates nothing.
template <Scalar S>
class LinkPullback {
 public:
  explicit LinkPullback(const Model& model);

  /// Removes all covectors.
  void clear();

  /// Adds covectors on a link's body, as defined by LinkCovectors.
  void add_to_body(int link, const Vector6<S>& by_displacement, const Vector6<S>& by_twist);
  /// Adds a covector on displacing a link's joint frame, independent of the body's pose in it.
  void add_to_joint(int link, const Vector6<S>& by_displacement);

  /// Sums the covectors along the tree. Call it once, before the functions below.
  void sum();

  /// by_q += gradient with respect to the coordinates.                               [dof]
  void add_coordinates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_q) const;
  /// by_qdot += gradient with respect to their rates.                                [dof]
  void add_rates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_qdot) const;
  /// grad_p += gradient with respect to the set's joint and body transformations.  [set.size()]
  void add_frames(const Applied<S>& applied, const Motion<S>& motion,
                  Eigen::Ref<VectorX<S>> grad_p) const;

 private:
  const Model& model_;
  LinkCovectors<S> bodies_;
  std::vector<Vector6<S>> by_displacement_;  // per node, after sum() of its subtree
  std::vector<Vector6<S>> by_twist_;         // per node, after sum() of its subtree
};

}  // namespace hbar
