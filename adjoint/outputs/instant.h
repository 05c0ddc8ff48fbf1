#pragma once

#include <optional>

#include "hbar/contact/contact_forces.h"
#include "hbar/core/parameters/applied.h"

namespace hbar {

/// One instant of a motion: what outputs are read from. Borrows everything.
template <Scalar S>
struct Instant {
  const Applied<S>& applied;
  const Motion<S>& motion;           ///< poses and twists at (q, q̇)
  const ContactForces<S>* contacts;  ///< linearised there; null if no output reads them
  VectorView<S> q;                   ///< coordinates                                    [dof]
  VectorView<S> qdot;                ///< their rates                                    [dof]
  VectorView<S> u;                   ///< controls                                  [controls]
};

/// Gradients with respect to everything an instant depends on. Borrows them; results are added.
template <Scalar S>
struct InstantGradient {
  Eigen::Ref<VectorX<S>> q;     ///<                                                    [dof]
  Eigen::Ref<VectorX<S>> qdot;  ///<                                                    [dof]
  Eigen::Ref<VectorX<S>> u;     ///<                                               [controls]
  Eigen::Ref<VectorX<S>> p;     ///<                                             [set.size()]
};

/// Makes instants for states at which no stage was linearised.
///
/// Borrows the model. Sized once, reused; allocates nothing (ContactForces' limit applies). Holds
/// its workspace and belongs to one thread at a time.
template <Scalar S>
class InstantMotion {
 public:
  InstantMotion(const Model& model, bool with_contacts);

  /// Computes the motion and, if requested, the contact forces.
  ///
  /// @param q, qdot  coordinates and rates                                              [dof]
  /// @param u        controls                                                      [controls]
  /// @returns        borrows the arguments; valid until the next call
  [[nodiscard]] Instant<S> at(const Applied<S>& applied, const VectorView<S>& q,
                              const VectorView<S>& qdot, const VectorView<S>& u);

 private:
  const Model& model_;
  Motion<S> motion_;
  std::optional<ContactForces<S>> contacts_;
  VectorX<S> none_;  // accelerations, which no output reads
};

}  // namespace hbar
