#pragma once

#include "hbar/core/dynamics/body_motion.h"
#include "hbar/core/dynamics/dynamics.h"

namespace hbar {

/// The transpose of the derivatives of inverse dynamics, applied to one vector z in O(nodes).
///
/// All of zᵀ ∂ID/∂(q, q̇, a) and zᵀ ∂ID/∂p follows from two sums along the tree: the twist
/// W = Σ_path J_l z_l that z gives each node, and per subtree a = I^C W_λ + Σ z_l I^C_l J_l and
/// b likewise with (B^C)ᵀ. A frame that displaces a subtree (joint coordinate, joint
/// transformation, body transformation: doc/notation.md) then has one covector
///
///     G = −A_λ ×* a + V_λ ×* (V_λ ×* a) − V_λ ×* b − W_λ ×* F
///
/// with zᵀ ∂ID/∂D = G·D for each of its displacement twists D. Wrenches that depend on the motion
/// of bodies, such as contact wrenches, add covectors on those bodies: those on displacements to G,
/// those on twists to b. Hence two phases: weigh() gives the twists W from which such covectors are
/// computed, finish() takes the covectors and sums. Sized once, reused; call after subtree_dynamics
/// with the same motion. Allocates nothing.
template <Scalar S>
class Pullback {
 public:
  explicit Pullback(const Model& model);

  /// First phase: the twist that z gives each node.
  ///
  /// @param z  weights on the rows of ID                                         [dof]
  /// @returns  by node: Σ over its path of J_l z_l; valid until the next weigh() [6]
  std::span<const Vector6<S>> weigh(const Model& model, const Motion<S>& motion,
                                    const Dynamics<S>& dynamics, const VectorView<S>& z);

  /// Second phase: computes all results below.
  ///
  /// @param z         as given to weigh()                                        [dof]
  /// @param external  covectors of wrenches on bodies; null: none
  void finish(const Model& model, const Motion<S>& motion, const Dynamics<S>& dynamics,
              const VectorView<S>& z, const LinkCovectors<S>* external = nullptr);

  VectorX<S> by_q;     ///< zᵀ ∂ID/∂q                                              [dof]
  VectorX<S> by_qdot;  ///< zᵀ ∂ID/∂q̇                                              [dof]
  VectorX<S> by_a;     ///< zᵀ M                                                   [dof]

  /// The twist that z gives a node: Σ over its path of J_l z_l.                   [6]
  [[nodiscard]] const Vector6<S>& twist(int node) const {
    return twists_[static_cast<std::size_t>(node)];
  }
  /// The same for all nodes.
  [[nodiscard]] std::span<const Vector6<S>> twists() const { return twists_; }
  /// Covector of displacing everything below a joint's rest frame; `node` is the first of its
  /// joint.                                                                       [6]
  [[nodiscard]] const Vector6<S>& joint_frame(int node) const {
    return joint_frames_[static_cast<std::size_t>(node)];
  }
  /// Covector of displacing a link's body alone, in its joint frame.              [6]
  ///
  /// @param external  as given to finish()
  [[nodiscard]] Vector6<S> body_frame(const Model& model, const Motion<S>& motion,
                                      const Dynamics<S>& dynamics, int link,
                                      const LinkCovectors<S>* external = nullptr) const;
  /// zᵀ ∂ID/∂gravity.                                                             [3]
  [[nodiscard]] const Vector3<S>& by_gravity() const { return by_gravity_; }

 private:
  void sum_node(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
                const VectorView<S>& z, int i);

  std::vector<Vector6<S>> twists_;
  std::vector<Vector6<S>> joint_frames_;
  std::vector<Vector6<S>> wrench_sums_;        // Σ over the subtree of z_l I^C_l J_l
  std::vector<Vector6<S>> rate_sums_;          // the same with (B^C_l)ᵀ, and external by twists
  std::vector<Vector6<S>> displacement_sums_;  // external by displacements
  Vector3<S> by_gravity_;
};

}  // namespace hbar
