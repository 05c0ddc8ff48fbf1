#pragma once

#include "hbar/core/dynamics/dynamics.h"

namespace hbar {

/// Weights of the combination q ∂ID/∂q + v ∂ID/∂q̇ + a M (one block of H̄).
template <Scalar S>
struct JacobianWeights {
  S q = S(0.0);
  S v = S(0.0);
  S a = S(0.0);
};

/// Derivatives of inverse dynamics by displacement columns (doc/notation.md, "Columns").
///
/// Each coordinate is a way to displace a subtree rigidly. Because rows are linear in a column's
/// pair (Ψ̈, Ψ̇), any combination of ∂ID/∂q, ∂ID/∂q̇ and M costs as much as one of them: combine
/// the columns first, then project. Sized once, reused; call after subtree_dynamics.
template <Scalar S>
class Columns {
 public:
  explicit Columns(const Tree& tree);

  /// Computes the displacements, which any number of projections then share. Allocates nothing.
  void prepare(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics);

  /// Computes one combination, after prepare.
  ///
  /// @param jacobian  the combination, rows by residual, columns by coordinate; entries of
  ///                  unrelated branches are set to zero                       [dof x dof]
  /// Allocates nothing.
  void project(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
               const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> jacobian) const;

  /// Both: prepare, then project.
  void combine(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
               const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> jacobian) {
    prepare(tree, motion, dynamics);
    project(tree, motion, dynamics, weights, jacobian);
  }

  /// Ψ̇ of coordinate c, after prepare.                                           [6]
  [[nodiscard]] Vector6<S> psi_dot(int c) const { return psi_dot_.col(c); }

 private:
  std::vector<std::vector<CoordinateRange>> below_;  // per node: its coordinates, its descendants'
  Matrix6X<S> psi_dot_;                              // by q_c
  Matrix6X<S> psi_ddot_;                             // by q_c
  Matrix6X<S> psi_ddot_by_rate_;                     // by q̇_c, where Ψ̇ is J_c
  // What rows multiply columns by, one row per coordinate, so that a run of rows is contiguous.
  Eigen::Matrix<S, Eigen::Dynamic, 6> rows_above_;  // J_l
  Eigen::Matrix<S, Eigen::Dynamic, 9> rows_below_;  // I^C J_l and the angular half of (B^C)ᵀ J_l
};

/// A frame that displaces everything below it: a joint's rest frame or a body frame
/// (Table II, I and II).
template <Scalar S>
struct FrameDisplacement {
  Vector6<S> psi_dot;   ///< Ψ̇
  Vector6<S> psi_ddot;  ///< Ψ̈
};

/// Ψ̇ and Ψ̈ of a world twist D carried by a node that moves as `carrier`.
template <Scalar S>
[[nodiscard]] inline FrameDisplacement<S> frame_displacement(const NodeMotion<S>& carrier,
                                                             const Vector6<S>& D) {
  const Vector6<S> psi_dot = cross_twist<S>(carrier.V, D);
  return {psi_dot, sum<S>(cross_twist<S>(carrier.A, D), cross_twist<S>(carrier.V, psi_dot))};
}

}  // namespace hbar
