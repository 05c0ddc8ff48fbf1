#pragma once

#include <span>

#include "hbar/core/dynamics/motion.h"

namespace hbar {

/// Dynamics of one body, or of all bodies below a node, in the world frame.
template <Scalar S>
struct BodyDynamics {
  SpatialInertia<S> I;    ///< mass distribution
  CoriolisOperator<S> B;  ///< velocity-dependent operator
  Vector6<S> F;           ///< rate of momentum minus external forces, a wrench [6]
};

/// Backward pass of the recursion (doc/notation.md): body quantities per link and their sums over
/// the subtree of each node (I^C, B^C, F^C). Sized once, reused.
template <Scalar S>
struct Dynamics {
  explicit Dynamics(const Model& model);

  [[nodiscard]] const BodyDynamics<S>& below(int node) const {
    return subtree[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] const BodyDynamics<S>& of_link(int link) const {
    return bodies[static_cast<std::size_t>(link)];
  }

  std::vector<BodyDynamics<S>> bodies;     ///< per link
  std::vector<BodyDynamics<S>> subtree;    ///< per node
  Matrix6X<S> IJ;                          ///< I^C J_l, per coordinate           [6 x dof]
  Eigen::Matrix<S, 3, Eigen::Dynamic> BJ;  ///< angular half of (B^C)ᵀ J_l      [3 x dof]
};

/// Inverse dynamics: the generalised forces that give accelerations a (recursive Newton-Euler),
/// with the accelerations and velocities that `motion` was computed at.
///
/// @param tau       ID(q, q̇, a; p), torque or force                             [dof]
/// @param wrenches  external wrenches on bodies, per link, world; each is subtracted from its
///                  body's F, so that tau is what the joints must add; empty: none   n of [6]
///
/// Allocates nothing.
template <Scalar S>
void inverse_dynamics(const Model& model, const Mechanism<S>& mechanism, const Motion<S>& motion,
                      Dynamics<S>& dynamics, Eigen::Ref<VectorX<S>> tau,
                      std::span<const Vector6<S>> wrenches = {});

/// The same, and all subtree sums needed by derivatives.
template <Scalar S>
void subtree_dynamics(const Model& model, const Mechanism<S>& mechanism, const Motion<S>& motion,
                      Dynamics<S>& dynamics, Eigen::Ref<VectorX<S>> tau,
                      std::span<const Vector6<S>> wrenches = {});

/// Mass matrix M(q) of (30), after subtree_dynamics.
///
/// @param M  symmetric positive definite                                        [dof x dof]
template <Scalar S>
void mass_matrix(const Model& model, const Motion<S>& motion, const Dynamics<S>& dynamics,
                 Eigen::Ref<MatrixX<S>> M);

}  // namespace hbar
