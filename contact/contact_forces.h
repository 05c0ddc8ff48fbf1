#pragma once

#include <span>

#include "hbar/contact/contact_pair.h"

namespace hbar {

/// What one contact does at one instant.
struct ContactSummary {
  int active = 0;               ///< points that touch
  int sticking = 0;             ///< of these, points that stick
  double penetration = 0.0;     ///< of the deepest point, length, ≥ 0
  double normal_force = 0.0;    ///< Σ f_n
  double friction_force = 0.0;  ///< Σ |friction|
};

/// A contact with touching points, and its derivatives.
template <Scalar S>
struct ActivePair {
  int contact = 0;
  std::size_t first = 0;  ///< its points in ContactForces::points()
  std::size_t count = 0;
  PairMotion<S> motion;
  PairWrenches<S> wrenches;
  PairStiffness<S> stiffness;
};

/// The forces of all declared contacts of a model: wrenches on bodies, their derivatives, and a
/// summary for the user.
///
/// A pair far apart costs one distance evaluation, and so does a point that does not touch. Sized
/// once and reused: evaluations allocate nothing while no more than a thousand points touch at
/// once.
template <Scalar S>
class ContactForces {
 public:
  explicit ContactForces(const Model& model);

  /// Wrenches alone, at the poses and twists of `motion`.
  void evaluate(const Mechanism<S>& mechanism, const Motion<S>& motion);
  /// The same, and what the derivatives below need.
  void linearize(const Mechanism<S>& mechanism, const Motion<S>& motion);

  /// Contact wrench on each link's body, world; empty if the model declares no contact.   [6]
  [[nodiscard]] std::span<const Vector6<S>> wrenches() const { return wrenches_; }
  [[nodiscard]] const ContactSummary& summary(int contact) const {
    return summaries_[static_cast<std::size_t>(contact)];
  }
  /// After linearize.
  [[nodiscard]] std::span<const ActivePair<S>> active() const { return {pairs_.data(), active_}; }
  [[nodiscard]] std::span<const TouchingPoint<S>> points(const ActivePair<S>& pair) const {
    return {points_.data() + pair.first, pair.count};
  }

  /// Adds the contribution of contact to a column of ∂ID/∂(displacement), after linearize.
  ///
  /// @param moves    moves(link): whether the displacement moves that link's body
  /// @param D        displacement twist, world                                        [6]
  /// @param psi_dot  Ψ̇ of doc/notation.md, "Columns"                                  [6]
  /// @param column   rows by coordinate                                               [dof]
  template <typename Moves>
  void add_displacement(const Motion<S>& motion, const Moves& moves, const Vector6<S>& D,
                        const Vector6<S>& psi_dot, Eigen::Ref<VectorX<S>> column) const;
  /// The same for displacing everything below a node.
  void add_displacement_below(const Motion<S>& motion, int node, const Vector6<S>& D,
                              const Vector6<S>& psi_dot, Eigen::Ref<VectorX<S>> column) const;

  /// Adds the effect of a change of a contact's wrenches on ID: −Jᵀ of both.
  void add_change(const Motion<S>& motion, int contact, const PairWrenches<S>& change,
                  Eigen::Ref<VectorX<S>> column) const;

  /// Transpose of add_displacement: for a weight z on the rows, given as the twists W that it
  /// induces, computes covectors on displacements and twists of bodies.
  ///
  /// @param W  by node: Σ over its path of J_l z_l                                    [6]
  void pull_back(std::span<const Vector6<S>> W, LinkCovectors<S>& out) const;

  /// Transpose of add_change.
  [[nodiscard]] S weigh(std::span<const Vector6<S>> W, int contact,
                        const PairWrenches<S>& change) const;

  [[nodiscard]] const Model& model() const { return model_; }

 private:
  void begin(const Mechanism<S>& mechanism, const Motion<S>& motion);
  template <bool kWithDerivatives>
  void run(const Mechanism<S>& mechanism, const Motion<S>& motion);
  template <bool kWithDerivatives>
  void run_pair(const Mechanism<S>& mechanism, int contact);
  void touch(const Contact& contact, const TouchingPoint<S>& point, ContactSummary& summary,
             PairWrenches<S>& wrenches) const;
  void add_rows(const Motion<S>& motion, int link, const Vector6<S>& wrench,
                Eigen::Ref<VectorX<S>>& column) const;

  const Model& model_;
  std::vector<std::vector<CoordinateRange>> paths_;  // per link: coordinates that move it
  std::vector<std::vector<char>> below_;             // per node: which links it moves
  std::vector<char> takes_part_;                     // per link
  std::vector<BodyMotion<S>> bodies_;                // per link
  BodyMotion<S> world_;
  std::vector<Vector6<S>> wrenches_;
  std::vector<ContactSummary> summaries_;
  std::vector<ActivePair<S>> pairs_;
  std::size_t active_ = 0;
  std::vector<TouchingPoint<S>> points_;
};

template <Scalar S>
template <typename Moves>
void ContactForces<S>::add_displacement(const Motion<S>& motion, const Moves& moves,
                                        const Vector6<S>& D, const Vector6<S>& psi_dot,
                                        Eigen::Ref<VectorX<S>> column) const {
  for (const ActivePair<S>& pair : active()) {
    const Contact& contact = model_.contact(pair.contact);
    const bool a = moves(contact.link);
    const bool b = contact.other >= 0 && moves(contact.other);
    const bool surface = contact.reaction == Reaction::kSurface;
    if (a == b && !(surface && b)) {
      continue;
    }
    PairWrenches<S> change;
    const PairStiffness<S>& k = pair.stiffness;
    if (a != b) {
      const S sign = S(a ? 1.0 : -1.0);
      const Vector6<S> answer = k.K_a * D + k.C_a * psi_dot;
      change.on_a = sign * (answer - cross_wrench<S>(D, pair.wrenches.on_a));
      if (surface) {
        change.on_b = sign * (k.K_b * D + k.C_b * psi_dot);
      } else {
        change.on_b = -sign * answer;
      }
    }
    if (surface && b) {
      change.on_a += k.E_a * psi_dot.template head<3>();
      change.on_b += k.E_b * psi_dot.template head<3>();
    }
    add_change(motion, pair.contact, change, column);
  }
}

}  // namespace hbar
