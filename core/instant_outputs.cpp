#include "hbar/core/instant_outputs.h"

namespace hbar {

template <Scalar S>
InstantOutputs<S>::InstantOutputs(const Model& model, const std::vector<Measurement>& measurements)
    : model_(model),
      motion_(model.tree()),
      end_effectors_(model),
      tactile_(model),
      measurements_(model, measurements),
      q_(VectorX<S>::Zero(model.dof())),
      qdot_(VectorX<S>::Zero(model.dof())),
      none_(VectorX<S>::Zero(model.dof())) {}

template <Scalar S>
bool InstantOutputs<S>::empty() const {
  return model_.variable_count() + model_.tactile_count() + measurements_.size() == 0;
}

template <Scalar S>
OutputRows<S> InstantOutputs<S>::zero_rows() const {
  return {VectorX<S>::Zero(model_.variable_count()), VectorX<S>::Zero(model_.tactile_count()),
          VectorX<S>::Zero(measurements_.size())};
}

template <Scalar S>
void InstantOutputs<S>::set_instant(const Mechanism<S>& mechanism, const VectorView<S>& q,
                                    const VectorView<S>& qdot) {
  q_ = q;
  qdot_ = qdot;
  compute_motion<S>(model_.tree(), mechanism, q_, qdot_, none_, motion_);
}

template <Scalar S>
void InstantOutputs<S>::read(const Mechanism<S>& mechanism, const VectorView<S>& u,
                             OutputRows<S>& out) {
  end_effectors_.positions(motion_, out.v);
  tactile_.readings(mechanism, motion_, out.tactile);
  measurements_.readings(mechanism, motion_, q_, qdot_, u, out.measured);
}

template <Scalar S>
void InstantOutputs<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                  const VectorView<S>& p, const VectorView<S>& u,
                                  const OutputRows<S>& y, Eigen::Ref<VectorX<S>> by_q,
                                  Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> by_u,
                                  Eigen::Ref<VectorX<S>> by_p) {
  if (y.v.size() > 0) {
    end_effectors_.pull_back(mechanism, set, p, motion_, y.v, by_q, by_p);
  }
  if (y.tactile.size() > 0) {
    tactile_.pull_back(mechanism, set, p, motion_, y.tactile, by_q, by_qdot, by_p);
  }
  if (y.measured.size() > 0) {
    measurements_.pull_back(mechanism, set, p, motion_, q_, qdot_, u, y.measured, by_q, by_qdot,
                            by_u, by_p);
  }
}

template class InstantOutputs<double>;
template class InstantOutputs<Dual>;

}  // namespace hbar
