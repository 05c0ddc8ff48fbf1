#include "hbar/adjoint/outputs/instant.h"

namespace hbar {

template <Scalar S>
InstantMotion<S>::InstantMotion(const Model& model, bool with_contacts)
    : model_(model), motion_(model.tree()), none_(VectorX<S>::Zero(model.dof())) {
  if (with_contacts) {
    contacts_.emplace(model);
  }
}

template <Scalar S>
Instant<S> InstantMotion<S>::at(const Applied<S>& applied, const VectorView<S>& q,
                                const VectorView<S>& qdot, const VectorView<S>& u) {
  compute_motion<S>(model_.tree(), applied.mechanism, q, qdot, none_, motion_);
  if (contacts_) {
    contacts_->linearize(applied.mechanism, motion_);
  }
  return {applied, motion_, contacts_ ? &*contacts_ : nullptr, q, qdot, u};
}

template class InstantMotion<double>;
template class InstantMotion<Dual>;

}  // namespace hbar
