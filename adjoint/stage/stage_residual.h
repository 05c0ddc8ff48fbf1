#pragma once

#include "hbar/contact/contact_forces.h"
#include "hbar/core/dynamics/columns.h"
#include "hbar/core/dynamics/joint_forces.h"
#include "hbar/core/dynamics/pullback.h"

namespace hbar {

/// The point at which a stage's residual is evaluated.
template <Scalar S>
struct StagePoint {
  explicit StagePoint(const Model& model);

  VectorX<S> q;        ///< rad or length                                         [dof]
  VectorX<S> qdot;     ///<                                                       [dof]
  VectorX<S> a;        ///< q̈ of the stage, Δ / c                                 [dof]
  VectorX<S> u;        ///< controls of the step                                  [controls]
  StepStart<S> start;  ///< state at the step's start
  double rate = 1.0;   ///< ∂q̇/∂q = ∂a/∂q̇ = C_own / h, 1/time

  /// c = β h² of (22), (24), (25), (28).
  [[nodiscard]] double c() const { return 1.0 / (rate * rate); }
};

/// The residual of every implicit stage, g = M Δ − c f_r = c (ID(q, q̇, a; p) − τ) (22), (24),
/// (25), (28), and its derivatives. Joint forces enter through τ, contact as wrenches on bodies.
///
/// Sized once, reused; evaluations allocate nothing. One object per thread.
template <Scalar S>
class StageResidual {
 public:
  explicit StageResidual(const Model& model);

  /// @param g  residual, c times torque or force                                  [dof]
  void residual(const Mechanism<S>& mechanism, const StagePoint<S>& point,
                Eigen::Ref<VectorX<S>> g);

  /// The same, and keeps what the derivatives below read.
  void linearize(const Mechanism<S>& mechanism, const StagePoint<S>& point,
                 Eigen::Ref<VectorX<S>> g);

  /// weights.q G_q + weights.v G_v + weights.a c M, with partial derivatives G_q = ∂g/∂q,
  /// G_v = ∂g/∂q̇, c M = ∂g/∂a.                                                     [dof x dof]
  void jacobian(const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> out);

  /// ∂g/∂q of the stage as Newton needs it: q̇ and a follow q.                   [dof x dof]
  void newton_matrix(Eigen::Ref<MatrixX<S>> out);

  /// Applies the transposed derivatives to z; the accessors below give the results.
  void pull_back(const VectorView<S>& z);

  [[nodiscard]] const VectorX<S>& by_q() const { return by_q_; }        ///< G_qᵀ z     [dof]
  [[nodiscard]] const VectorX<S>& by_qdot() const { return by_qdot_; }  ///< G_vᵀ z     [dof]
  [[nodiscard]] const VectorX<S>& by_a() const { return by_a_; }        ///< c M z      [dof]

  [[nodiscard]] double c() const { return c_; }
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const Motion<S>& motion() const { return motion_; }
  [[nodiscard]] const Dynamics<S>& dynamics() const { return dynamics_; }
  [[nodiscard]] const JointForces<S>& joint_forces() const { return joint_forces_; }
  [[nodiscard]] const ContactForces<S>& contacts() const { return contacts_; }
  /// zᵀ of inverse dynamics alone, without the factor c.
  [[nodiscard]] const Pullback<S>& pullback() const { return pullback_; }
  /// Covector of displacing a link's body alone, also without the factor c.         [6]
  [[nodiscard]] Vector6<S> body_frame(int link) const {
    return pullback_.body_frame(model_, motion_, dynamics_, link, touching_covectors());
  }

 private:
  /// Contribution of contact to the last pull_back; null if nothing touches.
  [[nodiscard]] const LinkCovectors<S>* touching_covectors() const {
    return contacts_.active().empty() ? nullptr : &contact_covectors_;
  }

  const Model& model_;
  Motion<S> motion_;
  ContactForces<S> contacts_;
  Dynamics<S> dynamics_;
  Columns<S> columns_;
  bool columns_ready_ = false;  // prepared at the last linearize
  JointForces<S> joint_forces_;
  Pullback<S> pullback_;
  LinkCovectors<S> contact_covectors_;  // of the last pull_back
  VectorX<S> by_q_;
  VectorX<S> by_qdot_;
  VectorX<S> by_a_;
  double c_ = 1.0;
  double rate_ = 1.0;
};

}  // namespace hbar
