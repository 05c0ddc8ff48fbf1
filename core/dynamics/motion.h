#pragma once

#include <array>
#include <vector>

#include "hbar/core/model/mechanism.h"

namespace hbar {

/// Pose, twist and spatial acceleration of one node's frame, in the world frame at its origin.
template <Scalar S>
struct NodeMotion {
  Matrix3<S> R;  ///< axes of the node's frame in the world                     [3 x 3]
  Vector3<S> p;  ///< its origin, length                                        [3]
  Vector6<S> V;  ///< twist, rad/time and length/time                           [6]
  Vector6<S> A;  ///< spatial acceleration with −gravity added (A₀ = −g)        [6]
};

/// Additional terms of an exponential rotation: derivatives of its varying motion subspace, as
/// world twists per coordinate c (doc/notation.md, "Columns").
template <Scalar S>
struct ExponentialMotion {
  std::array<Vector6<S>, 3> W;                  ///< Ad ∂(S q̇)/∂q_c
  std::array<Vector6<S>, 3> U;                  ///< Ad ∂(S a + Ṡ q̇)/∂q_c
  std::array<Vector6<S>, 3> Z;                  ///< Ad ∂(Ṡ q̇)/∂q̇_c
  std::array<std::array<Vector6<S>, 3>, 3> dJ;  ///< [c][l]: Ad ∂S_l/∂q_c
};

/// Forward pass of the recursion (doc/notation.md): the motion of every node at (q, q̇, a). Sized
/// once, reused.
template <Scalar S>
struct Motion {
  explicit Motion(const Tree& tree);

  /// Twist and acceleration of a node's parent, or of the world if it has none.
  [[nodiscard]] const NodeMotion<S>& parent_of(const Node& node) const {
    return node.parent < 0 ? world : nodes[static_cast<std::size_t>(node.parent)];
  }
  [[nodiscard]] const NodeMotion<S>& at(int node) const {
    return nodes[static_cast<std::size_t>(node)];
  }
  /// Of a node that is an exponential rotation.
  [[nodiscard]] const ExponentialMotion<S>& exponential(int node) const {
    return exponentials[static_cast<std::size_t>(exponential_of[static_cast<std::size_t>(node)])];
  }

  NodeMotion<S> world;                             ///< at rest, A = (0; −gravity)
  std::vector<NodeMotion<S>> nodes;                ///< per node
  Matrix6X<S> J;                                   ///< world twist per unit q̇     [6 x dof]
  std::vector<ExponentialMotion<S>> exponentials;  ///< per exponential node
  std::vector<int> exponential_of;                 ///< per node: index above, or −1
};

/// @param q     joint coordinates, rad or length                                  [dof]
/// @param qdot  their rates                                                       [dof]
/// @param a     their accelerations                                               [dof]
/// Allocates nothing. Sizes are preconditions.
template <Scalar S>
void compute_motion(const Tree& tree, const Mechanism<S>& mechanism, const VectorView<S>& q,
                    const VectorView<S>& qdot, const VectorView<S>& a, Motion<S>& motion);

/// World pose of a link's joint frame before the joint moves: the parent's joint frame times X_PJ.
template <Scalar S>
[[nodiscard]] RigidTransform<S> rest_frame(const Model& model, const Mechanism<S>& mechanism,
                                           const Motion<S>& motion, int link);

/// First node of a link's joint.
[[nodiscard]] int first_node_of_link(const Model& model, int link);

}  // namespace hbar
