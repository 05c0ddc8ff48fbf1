#include "hbar/adjoint/stage/stage_residual.h"

namespace hbar {

template <Scalar S>
StagePoint<S>::StagePoint(const Model& model)
    : q(VectorX<S>::Zero(model.dof())),
      qdot(VectorX<S>::Zero(model.dof())),
      a(VectorX<S>::Zero(model.dof())),
      u(VectorX<S>::Zero(model.control_count())),
      start{VectorX<S>::Zero(model.dof()), VectorX<S>::Zero(model.dof())} {}

template <Scalar S>
StageResidual<S>::StageResidual(const Model& model)
    : model_(model),
      motion_(model.tree()),
      contacts_(model),
      dynamics_(model),
      columns_(model.tree()),
      joint_forces_(model),
      pullback_(model),
      contact_covectors_(model.link_count()),
      by_q_(VectorX<S>::Zero(model.dof())),
      by_qdot_(VectorX<S>::Zero(model.dof())),
      by_a_(VectorX<S>::Zero(model.dof())) {}

template <Scalar S>
void StageResidual<S>::residual(const Mechanism<S>& mechanism, const StagePoint<S>& point,
                                Eigen::Ref<VectorX<S>> g) {
  compute_motion<S>(model_.tree(), mechanism, point.q, point.qdot, point.a, motion_);
  contacts_.evaluate(mechanism, motion_);
  inverse_dynamics<S>(model_, mechanism, motion_, dynamics_, g, contacts_.wrenches());
  compute_joint_forces<S>(model_, mechanism, point.q, point.qdot, point.u, point.start,
                          joint_forces_);
  g = point.c() * (g - joint_forces_.tau);
}

template <Scalar S>
void StageResidual<S>::linearize(const Mechanism<S>& mechanism, const StagePoint<S>& point,
                                 Eigen::Ref<VectorX<S>> g) {
  c_ = point.c();
  rate_ = point.rate;
  compute_motion<S>(model_.tree(), mechanism, point.q, point.qdot, point.a, motion_);
  contacts_.linearize(mechanism, motion_);
  subtree_dynamics<S>(model_, mechanism, motion_, dynamics_, g, contacts_.wrenches());
  compute_joint_forces<S>(model_, mechanism, point.q, point.qdot, point.u, point.start,
                          joint_forces_);
  g = c_ * (g - joint_forces_.tau);
  columns_ready_ = false;
}

template <Scalar S>
void StageResidual<S>::jacobian(const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> out) {
  const JacobianWeights<S> scaled = {c_ * weights.q, c_ * weights.v, c_ * weights.a};
  if (!columns_ready_) {
    columns_.prepare(model_.tree(), motion_, dynamics_);
    columns_ready_ = true;
  }
  columns_.project(model_.tree(), motion_, dynamics_, scaled, out);
  if (!contacts_.active().empty()) {
    for (int c = 0; c < model_.dof(); ++c) {
      const Vector6<S> J = motion_.J.col(c);
      const Vector6<S> psi_dot = scaled.q * columns_.psi_dot(c) + scaled.v * J;
      contacts_.add_displacement_below(motion_, model_.tree().node_of(c), scaled.q * J, psi_dot,
                                       out.col(c));
    }
  }
  out.diagonal() -= scaled.q * joint_forces_.by_q + scaled.v * joint_forces_.by_qdot;
}

template <Scalar S>
void StageResidual<S>::newton_matrix(Eigen::Ref<MatrixX<S>> out) {
  jacobian({S(1.0), S(rate_), S(rate_ * rate_)}, out);
}

template <Scalar S>
void StageResidual<S>::pull_back(const VectorView<S>& z) {
  const auto twists = pullback_.weigh(model_, motion_, dynamics_, z);
  if (!contacts_.active().empty()) {
    contacts_.pull_back(twists, contact_covectors_);
  }
  pullback_.finish(model_, motion_, dynamics_, z, touching_covectors());
  by_q_ = c_ * (pullback_.by_q - z.cwiseProduct(joint_forces_.by_q));
  by_qdot_ = c_ * (pullback_.by_qdot - z.cwiseProduct(joint_forces_.by_qdot));
  by_a_ = c_ * pullback_.by_a;
}

template struct StagePoint<double>;
template struct StagePoint<Dual>;
template class StageResidual<double>;
template class StageResidual<Dual>;

}  // namespace hbar
