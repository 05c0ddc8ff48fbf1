#include "hbar/core/dynamics/pullback.h"

namespace hbar {
namespace {

/// G of the class comment, without external displacements.
template <Scalar S>
inline Vector6<S> displacement_covector(const NodeMotion<S>& carrier, const Vector6<S>& a,
                                        const Vector6<S>& b, const Vector6<S>& W,
                                        const Vector6<S>& F) {
  Vector6<S> inner = cross_wrench<S>(carrier.V, a);
  for (int i = 0; i < 6; ++i) {
    inner[i] -= b[i];
  }
  return sum<S>(cross_wrench<S>(carrier.V, inner), cross_wrench<S>(-carrier.A, a),
                cross_wrench<S>(-W, F));
}

/// Adds Bᵀ W, whose translational half is zero.
template <Scalar S>
inline void add_coriolis(const CoriolisOperator<S>& B, const Vector6<S>& W, Vector6<S>& b) {
  const Vector3<S> angular = B.transposed_times(W);
  for (int l = 0; l < 3; ++l) {
    b[l] += angular[l];
  }
}

}  // namespace

template <Scalar S>
Pullback<S>::Pullback(const Model& model)
    : by_q(VectorX<S>::Zero(model.dof())),
      by_qdot(VectorX<S>::Zero(model.dof())),
      by_a(VectorX<S>::Zero(model.dof())),
      twists_(static_cast<std::size_t>(model.tree().node_count())),
      joint_frames_(twists_.size()),
      wrench_sums_(twists_.size()),
      rate_sums_(twists_.size()),
      displacement_sums_(twists_.size()) {
  by_gravity_.setZero();
}

template <Scalar S>
std::span<const Vector6<S>> Pullback<S>::weigh(const Model& model, const Motion<S>& motion,
                                               const Dynamics<S>& dynamics,
                                               const VectorView<S>& z) {
  const Tree& tree = model.tree();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const auto k = static_cast<std::size_t>(i);
    if (node.parent < 0) {
      twists_[k].setZero();
    } else {
      twists_[k] = twist(node.parent);
    }
    wrench_sums_[k].setZero();
    rate_sums_[k].setZero();
    displacement_sums_[k].setZero();
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      twists_[k] += z[c] * motion.J.col(c);
      wrench_sums_[k] += z[c] * dynamics.IJ.col(c);
      for (int l = 0; l < 3; ++l) {
        rate_sums_[k][l] += z[c] * dynamics.BJ(l, c);
      }
    }
  }
  return twists_;
}

/// Called when the subtree's sums are complete: computes its derivatives and adds its part to the
/// parent's sums.
template <Scalar S>
void Pullback<S>::sum_node(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
                           const VectorView<S>& z, int i) {
  const Node& node = tree.node(i);
  const auto k = static_cast<std::size_t>(i);
  const NodeMotion<S>& parent = motion.parent_of(node);
  const Vector6<S> at_rest = Vector6<S>::Zero();
  const Vector6<S>& W = node.parent < 0 ? at_rest : twist(node.parent);
  const BodyDynamics<S>& below = dynamics.below(i);
  const Vector6<S> a = sum<S>(below.I * W, wrench_sums_[k]);
  Vector6<S> b = rate_sums_[k];
  add_coriolis<S>(below.B, W, b);
  const Vector6<S> G =
      sum<S>(displacement_covector<S>(parent, a, b, W, below.F), displacement_sums_[k]);
  joint_frames_[k] = G;
  const Vector6<S> V_sum = parent.V + motion.at(i).V;
  for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
    const Vector6<S> J = motion.J.col(c);
    by_q[c] = power<S>(G, J);
    by_qdot[c] = power<S>(a, cross_twist<S>(V_sum, J)) + power<S>(b, J);
    by_a[c] = power<S>(a, J);
    if (node.motion == MotionKind::kExponential) {
      const ExponentialMotion<S>& extra = motion.exponential(i);
      const auto e = static_cast<std::size_t>(c - node.coordinates.begin);
      by_q[c] += a.dot(cross_twist<S>(V_sum, extra.W[e]) + extra.U[e]) + b.dot(extra.W[e]);
      by_qdot[c] += a.dot(extra.Z[e]);
      for (std::size_t l = 0; l < 3; ++l) {
        by_q[c] += z[node.coordinates.begin + static_cast<int>(l)] * extra.dJ[e][l].dot(below.F);
      }
    }
  }
  if (node.parent >= 0) {
    const auto above = static_cast<std::size_t>(node.parent);
    wrench_sums_[above] += wrench_sums_[k];
    rate_sums_[above] += rate_sums_[k];
    displacement_sums_[above] += displacement_sums_[k];
  } else {
    by_gravity_ -= wrench_sums_[k].template tail<3>();
  }
}

template <Scalar S>
void Pullback<S>::finish(const Model& model, const Motion<S>& motion, const Dynamics<S>& dynamics,
                         const VectorView<S>& z, const LinkCovectors<S>* external) {
  const Tree& tree = model.tree();
  if (external != nullptr) {
    for (int link = 0; link < model.link_count(); ++link) {
      const auto k = static_cast<std::size_t>(model.node_of_link(link));
      rate_sums_[k] += external->by_twist[static_cast<std::size_t>(link)];
      displacement_sums_[k] += external->by_displacement[static_cast<std::size_t>(link)];
    }
  }
  by_gravity_.setZero();
  for (int i = tree.node_count(); i-- > 0;) {
    sum_node(tree, motion, dynamics, z, i);
  }
}

template <Scalar S>
Vector6<S> Pullback<S>::body_frame(const Model& model, const Motion<S>& motion,
                                   const Dynamics<S>& dynamics, int link,
                                   const LinkCovectors<S>* external) const {
  const int i = model.node_of_link(link);
  const BodyDynamics<S>& body = dynamics.of_link(link);
  const Vector6<S>& W = twist(i);
  Vector6<S> b = Vector6<S>::Zero();
  Vector6<S> by_displacement = Vector6<S>::Zero();
  if (external != nullptr) {
    b = external->by_twist[static_cast<std::size_t>(link)];
    by_displacement = external->by_displacement[static_cast<std::size_t>(link)];
  }
  add_coriolis<S>(body.B, W, b);
  return by_displacement + displacement_covector<S>(motion.at(i), body.I * W, b, W, body.F);
}

template class Pullback<double>;
template class Pullback<Dual>;

}  // namespace hbar
