#pragma once

#include "hbar/core/dynamics.h"

namespace hbar {

/// Weights of the combination  q ∂ID/∂q + v ∂ID/∂q̇ + a M  (formulation §4: one block of H̄).
template <Scalar S>
struct JacobianWeights {
  S q = S(0.0);
  S v = S(0.0);
  S a = S(0.0);
};

/// Derivatives of inverse dynamics by displacement columns (formulation §3).
///
/// Each coordinate is a way to displace a subtree rigidly. Because rows are linear in a column's
/// pair (Ψ̈, Ψ̇), any combination of ∂ID/∂q, ∂ID/∂q̇ and M costs what one of them costs: combine the
/// columns first, then project. Sized once, reused; call after subtree_dynamics.
template <Scalar S>
class Columns {
 public:
  explicit Columns(const Tree& tree);

  /// @param jacobian  the combination, rows by residual, columns by coordinate; entries of
  ///                  unrelated branches are set to zero                       [dof x dof]
  /// Allocates nothing.
  void combine(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
               const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> jacobian);

 private:
  void prepare(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
               const JacobianWeights<S>& weights);

  // One row per coordinate, so that a run of ancestors is contiguous in each of the six (three).
  Eigen::Matrix<S, Eigen::Dynamic, 6> J_;
  Eigen::Matrix<S, Eigen::Dynamic, 6> psi_ddot_;
  Eigen::Matrix<S, Eigen::Dynamic, 3> psi_dot_;  // the angular half is all that rows read
  Matrix6X<S> ancestor_wrench_;
};

/// A frame that displaces what stands below it: a joint's rest frame or a body frame
/// (Table II, I and II).
template <Scalar S>
struct FrameDisplacement {
  Vector6<S> psi_dot;   ///< Ψ̇
  Vector6<S> psi_ddot;  ///< Ψ̈
};

/// Ψ̇ and Ψ̈ of a world twist D that is carried by a node moving as `carrier`.
template <Scalar S>
[[nodiscard]] FrameDisplacement<S> frame_displacement(const NodeMotion<S>& carrier,
                                                      const Vector6<S>& D) {
  const Vector6<S> psi_dot = cross_twist<S>(carrier.V, D);
  return {psi_dot, cross_twist<S>(carrier.A, D) + cross_twist<S>(carrier.V, psi_dot)};
}

}  // namespace hbar
