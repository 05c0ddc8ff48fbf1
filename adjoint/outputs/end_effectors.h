#pragma once

#include "hbar/core/parameters/link_pullback.h"

namespace hbar {

/// The auxiliary variables v: world positions of the end effectors, three each, in order.
///
/// Sized once, reused; evaluations allocate nothing.
template <Scalar S>
class EndEffectors {
 public:
  explicit EndEffectors(const Model& model);

  /// v(q, p), after compute_motion.
  ///
  /// @param v  world positions, length                                       [variables]
  void positions(const Motion<S>& motion, Eigen::Ref<VectorX<S>> v) const;

  /// Transposed derivative: weights y on v give by_q += (∂v/∂q)ᵀ y and grad_p += (∂v/∂p)ᵀ y.
  ///
  /// @param y       weights on the variables                                 [variables]
  /// @param by_q    gradient by the coordinates                              [dof]
  /// @param grad_p  gradient by the set's parameters                         [set.size()]
  void pull_back(const Mechanism<S>& mechanism, const ParameterSet& set, const VectorView<S>& p,
                 const Motion<S>& motion, const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                 Eigen::Ref<VectorX<S>> grad_p);

  /// ∂v/∂q.                                                                  [variables x dof]
  void jacobian(const Motion<S>& motion, Eigen::Ref<MatrixX<S>> dv_dq) const;

 private:
  [[nodiscard]] Vector3<S> position(const Motion<S>& motion, std::size_t i) const;

  const Model& model_;
  LinkPullback<S> links_;
};

}  // namespace hbar
