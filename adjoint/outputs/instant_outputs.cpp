#include "hbar/adjoint/outputs/instant_outputs.h"

#include <algorithm>

namespace hbar {
namespace {

/// Whether weights have any effect.
template <Scalar S>
bool counts(const VectorX<S>& weights) {
  return std::any_of(weights.begin(), weights.end(), [](const S& weight) {
    if constexpr (std::same_as<S, Dual>) {
      return weight.value != 0.0 || weight.slope != 0.0;
    } else {
      return weight != 0.0;
    }
  });
}

}  // namespace

template <Scalar S>
InstantOutputs<S>::InstantOutputs(const Model& model, const std::vector<Measurement>& measurements)
    : model_(model),
      motion_(model.tree()),
      end_effectors_(model),
      tactile_(model),
      measurements_(model, measurements),
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
const Motion<S>& InstantOutputs<S>::motion_at(const Mechanism<S>& mechanism, const VectorView<S>& q,
                                              const VectorView<S>& qdot) {
  compute_motion<S>(model_.tree(), mechanism, q, qdot, none_, motion_);
  return motion_;
}

template <Scalar S>
void InstantOutputs<S>::read(const Mechanism<S>& mechanism, const Motion<S>& motion,
                             const VectorView<S>& q, const VectorView<S>& qdot,
                             const VectorView<S>& u, OutputRows<S>& out) {
  end_effectors_.positions(motion, out.v);
  tactile_.readings(mechanism, motion, out.tactile);
  measurements_.readings(mechanism, motion, q, qdot, u, out.measured);
}

template <Scalar S>
void InstantOutputs<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                  const VectorView<S>& p, const Motion<S>& motion,
                                  const VectorView<S>& q, const VectorView<S>& qdot,
                                  const VectorView<S>& u, const OutputRows<S>& y,
                                  Eigen::Ref<VectorX<S>> by_q, Eigen::Ref<VectorX<S>> by_qdot,
                                  Eigen::Ref<VectorX<S>> by_u, Eigen::Ref<VectorX<S>> by_p) {
  if (counts<S>(y.v)) {
    end_effectors_.pull_back(mechanism, set, p, motion, y.v, by_q, by_p);
  }
  if (counts<S>(y.tactile)) {
    tactile_.pull_back(mechanism, set, p, motion, y.tactile, by_q, by_qdot, by_p);
  }
  if (counts<S>(y.measured)) {
    measurements_.pull_back(mechanism, set, p, motion, q, qdot, u, y.measured, by_q, by_qdot, by_u,
                            by_p);
  }
}

template class InstantOutputs<double>;
template class InstantOutputs<Dual>;

}  // namespace hbar
