#include "hbar/contact/contact_forces.h"

#include <algorithm>

namespace hbar {
namespace {

/// Coordinates above and of a node, ascending.
std::vector<CoordinateRange> path_of(const Tree& tree, int node) {
  std::vector<CoordinateRange> path;
  for (const CoordinateRange& above : tree.ancestors(node)) {
    path.push_back(above);
  }
  std::reverse(path.begin(), path.end());
  const CoordinateRange own = tree.node(node).coordinates;
  if (own.begin != own.end) {
    path.push_back(own);
  }
  return path;
}

template <Scalar S>
LawNumbers<S> law_numbers(const Mechanism<S>& mechanism, const Contact& contact, int index) {
  const auto k = mechanism.contact_coefficients.col(index);
  return {k[0], k[1], k[2], k[3], mechanism.contact_scale[contact.link]};
}

template <Scalar S>
Eigen::Vector3d values(const Vector3<S>& v) {
  return v.unaryExpr([](const S& entry) { return value_of(entry); });
}

/// Visits the contact points that touch: visit(index, place in A's frame). Clusters that are too
/// far away cost one distance each, and so do the points of the others.
template <Scalar S, typename Visit>
void for_each_candidate(const Model& model, const Mechanism<S>& mechanism, const Contact& contact,
                        const SurfaceDistance<S>& surface, const RigidTransform<S>& X_BA,
                        const Visit& visit) {
  const auto a = static_cast<std::size_t>(contact.link);
  const auto& points = mechanism.contact_points[a];
  const Eigen::Matrix4Xd& bounds = mechanism.contact_clusters[a];
  const PointClusters& clusters = model.point_clusters(contact.link);
  const Eigen::Matrix3d R = X_BA.R.unaryExpr([](const S& entry) { return value_of(entry); });
  const Eigen::Vector3d p = values<S>(X_BA.p);
  for (int c = 0; c < clusters.size(); ++c) {
    const Eigen::Vector3d middle = R * bounds.col(c).template head<3>() + p;
    if (surface.lower_bound(middle) > bounds(3, c)) {
      continue;
    }
    const auto k = static_cast<std::size_t>(c);
    for (int j = clusters.first[k]; j < clusters.first[k + 1]; ++j) {
      const int i = clusters.points[static_cast<std::size_t>(j)];
      const Vector3<S> x_A = points.col(i);
      if (surface.touches(surface.lower_bound(R * values<S>(x_A) + p))) {
        visit(i, x_A);
      }
    }
  }
}

}  // namespace

template <Scalar S>
ContactForces<S>::ContactForces(const Model& model)
    : model_(model),
      takes_part_(static_cast<std::size_t>(model.link_count()), 0),
      bodies_(takes_part_.size()),
      summaries_(model.contacts().size()) {
  if (model.contacts().empty()) {
    return;
  }
  wrenches_.resize(takes_part_.size());
  pairs_.resize(model.contacts().size());
  Eigen::Index points = 0;
  for (const Contact& contact : model.contacts()) {
    points += std::max<Eigen::Index>(model.link(contact.link).body.contact_points.cols(), 1);
    takes_part_[static_cast<std::size_t>(contact.link)] = 1;
    if (contact.other >= 0) {
      takes_part_[static_cast<std::size_t>(contact.other)] = 1;
    }
  }
  points_.reserve(std::min(static_cast<std::size_t>(points), kReservedTouches));
  const Tree& tree = model.tree();
  for (int i = 0; i < model.link_count(); ++i) {
    paths_.push_back(path_of(tree, model.node_of_link(i)));
  }
  for (int node = 0; node < tree.node_count(); ++node) {
    below_.emplace_back(takes_part_.size(), 0);
    for (int i = 0; i < model.link_count(); ++i) {
      below_.back()[static_cast<std::size_t>(i)] = tree.is_on_path(node, model.node_of_link(i));
    }
  }
}

template <Scalar S>
void ContactForces<S>::begin(const Mechanism<S>& mechanism, const Motion<S>& motion) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    wrenches_[i].setZero();
    if (takes_part_[i] != 0) {
      bodies_[i] = body_motion<S>(model_, mechanism, motion, static_cast<int>(i));
    }
  }
  active_ = 0;
  points_.clear();
}

template <Scalar S>
void ContactForces<S>::touch(const Contact& contact, const TouchingPoint<S>& point,
                             ContactSummary& summary, PairWrenches<S>& wrenches) const {
  add_wrenches<S>(contact.reaction, point, wrenches);
  ++summary.active;
  summary.sticking += point.force.sticks ? 1 : 0;
  summary.penetration = std::max(summary.penetration, -value_of(point.d));
  summary.normal_force += value_of(point.force.normal);
  summary.friction_force += value_of(point.force.friction);
}

template <Scalar S>
template <bool kWithDerivatives>
void ContactForces<S>::run_pair(const Mechanism<S>& mechanism, int index) {
  const Contact& contact = model_.contact(index);
  const auto a = static_cast<std::size_t>(contact.link);
  ContactSummary& summary = summaries_[static_cast<std::size_t>(index)];
  summary = {};
  ActivePair<S>& pair = pairs_[active_];
  pair.motion = {bodies_[a],
                 contact.other < 0 ? world_ : bodies_[static_cast<std::size_t>(contact.other)]};
  const int other = std::max(contact.other, 0);
  const SurfaceDistance<S> surface(contact.surface, model_.link(other).body.shape,
                                   mechanism.sizes.col(other));
  const RigidTransform<S> X_BA = inverse(pair.motion.b.X_WB) * pair.motion.a.X_WB;
  const bool rolls = touches_as_ball(model_, contact);
  const double reach =
      rolls ? value_of(mechanism.sizes(0, contact.link)) : mechanism.contact_radius[contact.link];
  if (surface.lower_bound(values<S>(X_BA.p)) > reach) {
    return;
  }
  const LawNumbers<S> numbers = law_numbers<S>(mechanism, contact, index);
  pair.contact = index;
  pair.first = points_.size();
  pair.wrenches = {};
  TouchingPoint<S> scratch;
  const auto add = [&](int point, const Vector3<S>& x_A, const S& radius) {
    if constexpr (kWithDerivatives) {
      points_.emplace_back();
    }
    TouchingPoint<S>& touching = kWithDerivatives ? points_.back() : scratch;
    compute_touch<S>(contact, numbers, surface, pair.motion, point, x_A, radius,
                     kWithDerivatives ? TouchDetail::kDerivatives : TouchDetail::kForce, touching);
    touch(contact, touching, summary, pair.wrenches);
  };
  if (rolls) {
    if (surface.touches(value_of(surface.sample(X_BA.p).d) - reach)) {
      add(-1, Vector3<S>::Zero(), mechanism.sizes(0, contact.link));
    }
  } else {
    for_each_candidate<S>(model_, mechanism, contact, surface, X_BA,
                          [&](int i, const Vector3<S>& x_A) { add(i, x_A, S(0.0)); });
  }
  if (summary.active == 0) {
    return;
  }
  wrenches_[a] += pair.wrenches.on_a;
  if (contact.other >= 0) {
    wrenches_[static_cast<std::size_t>(contact.other)] += pair.wrenches.on_b;
  }
  if constexpr (kWithDerivatives) {
    pair.count = points_.size() - pair.first;
    ++active_;
    PairStiffness<S>& stiffness = pair.stiffness;
    for (Matrix6<S>* matrix : {&stiffness.K_a, &stiffness.C_a, &stiffness.K_b, &stiffness.C_b}) {
      matrix->setZero();
    }
    stiffness.E_a.setZero();
    stiffness.E_b.setZero();
    for (const TouchingPoint<S>& point : points(pair)) {
      add_stiffness<S>(contact.reaction, pair.motion, point, stiffness);
    }
    complete<S>(contact.reaction, pair.motion, stiffness);
  }
}

template <Scalar S>
template <bool kWithDerivatives>
void ContactForces<S>::run(const Mechanism<S>& mechanism, const Motion<S>& motion) {
  if (model_.contacts().empty()) {
    return;
  }
  begin(mechanism, motion);
  for (int i = 0; i < model_.contact_count(); ++i) {
    run_pair<kWithDerivatives>(mechanism, i);
  }
}

template <Scalar S>
void ContactForces<S>::evaluate(const Mechanism<S>& mechanism, const Motion<S>& motion) {
  run<false>(mechanism, motion);
}

template <Scalar S>
void ContactForces<S>::linearize(const Mechanism<S>& mechanism, const Motion<S>& motion) {
  run<true>(mechanism, motion);
}

template <Scalar S>
void ContactForces<S>::add_rows(const Motion<S>& motion, int link, const Vector6<S>& wrench,
                                Eigen::Ref<VectorX<S>>& column) const {
  for (const CoordinateRange& rows : paths_[static_cast<std::size_t>(link)]) {
    const S* J = motion.J.col(rows.begin).data();
    for (int l = rows.begin; l < rows.end; ++l, J += 6) {
      // Two sums that do not wait for each other.
      const S even = wrench[0] * J[0] + wrench[2] * J[2] + wrench[4] * J[4];
      const S odd = wrench[1] * J[1] + wrench[3] * J[3] + wrench[5] * J[5];
      column[l] -= even + odd;
    }
  }
}

template <Scalar S>
void ContactForces<S>::add_change(const Motion<S>& motion, int contact,
                                  const PairWrenches<S>& change,
                                  Eigen::Ref<VectorX<S>> column) const {
  const Contact& owner = model_.contact(contact);
  add_rows(motion, owner.link, change.on_a, column);
  if (owner.other >= 0) {
    add_rows(motion, owner.other, change.on_b, column);
  }
}

template <Scalar S>
void ContactForces<S>::add_displacement_below(const Motion<S>& motion, int node,
                                              const Vector6<S>& D, const Vector6<S>& psi_dot,
                                              Eigen::Ref<VectorX<S>> column) const {
  if (active_ == 0) {
    return;
  }
  const std::vector<char>& below = below_[static_cast<std::size_t>(node)];
  add_displacement(
      motion, [&below](int link) { return below[static_cast<std::size_t>(link)] != 0; }, D, psi_dot,
      column);
}

template <Scalar S>
void ContactForces<S>::pull_back(std::span<const Vector6<S>> W, LinkCovectors<S>& out) const {
  const auto twist = [&](int link) -> const Vector6<S>& {
    return W[static_cast<std::size_t>(model_.node_of_link(link))];
  };
  for (std::size_t i = 0; i < out.by_twist.size(); ++i) {
    out.by_displacement[i].setZero();
    out.by_twist[i].setZero();
  }
  for (const ActivePair<S>& pair : active()) {
    const Contact& contact = model_.contact(pair.contact);
    const PairStiffness<S>& k = pair.stiffness;
    const auto a = static_cast<std::size_t>(contact.link);
    const Vector6<S>& W_a = twist(contact.link);
    Vector6<S> by_displacement =
        -(k.K_a.transpose() * W_a) - cross_wrench<S>(W_a, pair.wrenches.on_a);
    Vector6<S> by_twist = -(k.C_a.transpose() * W_a);
    if (contact.other >= 0) {
      const auto b = static_cast<std::size_t>(contact.other);
      const Vector6<S>& W_b = twist(contact.other);
      by_displacement -= k.K_b.transpose() * W_b;
      by_twist -= k.C_b.transpose() * W_b;
      out.by_displacement[b] -= by_displacement;
      out.by_twist[b] -= by_twist;
      if (contact.reaction == Reaction::kSurface) {
        out.by_twist[b].template head<3>() -= k.E_a.transpose() * W_a + k.E_b.transpose() * W_b;
      }
    }
    out.by_displacement[a] += by_displacement;
    out.by_twist[a] += by_twist;
  }
}

template <Scalar S>
S ContactForces<S>::weigh(std::span<const Vector6<S>> W, int contact,
                          const PairWrenches<S>& change) const {
  const Contact& owner = model_.contact(contact);
  const auto twist = [&](int link) -> const Vector6<S>& {
    return W[static_cast<std::size_t>(model_.node_of_link(link))];
  };
  S out = -power<S>(change.on_a, twist(owner.link));
  if (owner.other >= 0) {
    out -= power<S>(change.on_b, twist(owner.other));
  }
  return out;
}

template class ContactForces<double>;
template class ContactForces<Dual>;

}  // namespace hbar
