#include "hbar/core/pullback.h"

namespace hbar {
namespace {

/// G of the class comment.
template <Scalar S>
inline Vector6<S> displacement_covector(const NodeMotion<S>& carrier, const Vector6<S>& a,
                                        const Vector3<S>& b, const Vector6<S>& W,
                                        const Vector6<S>& F) {
  Vector6<S> inner = cross_wrench<S>(carrier.V, a);
  for (int i = 0; i < 3; ++i) {
    inner[i] -= b[i];
  }
  return sum<S>(cross_wrench<S>(carrier.V, inner), cross_wrench<S>(-carrier.A, a),
                cross_wrench<S>(-W, F));
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
      coriolis_sums_(twists_.size()) {
  by_gravity_.setZero();
}

template <Scalar S>
void Pullback<S>::compute(const Model& model, const Motion<S>& motion, const Dynamics<S>& dynamics,
                          const VectorView<S>& z) {
  const Tree& tree = model.tree();
  const Vector6<S> at_rest = Vector6<S>::Zero();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const auto k = static_cast<std::size_t>(i);
    twists_[k] = node.parent < 0 ? at_rest : twist(node.parent);
    wrench_sums_[k].setZero();
    coriolis_sums_[k].setZero();
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      twists_[k] += z[c] * motion.J.col(c);
      wrench_sums_[k] += z[c] * dynamics.IJ.col(c);
      coriolis_sums_[k] += z[c] * dynamics.BJ.col(c);
    }
  }
  by_gravity_.setZero();
  for (int i = tree.node_count(); i-- > 0;) {
    const Node& node = tree.node(i);
    const auto k = static_cast<std::size_t>(i);
    const NodeMotion<S>& parent = motion.parent_of(node);
    const Vector6<S>& W = node.parent < 0 ? at_rest : twist(node.parent);
    const BodyDynamics<S>& below = dynamics.below(i);
    const Vector6<S> a = sum<S>(below.I * W, wrench_sums_[k]);
    Vector3<S> b = below.B.transposed_times(W);
    for (int l = 0; l < 3; ++l) {
      b[l] += coriolis_sums_[k][l];
    }
    const Vector6<S> G = displacement_covector<S>(parent, a, b, W, below.F);
    joint_frames_[k] = G;
    const Vector6<S> V_sum = parent.V + motion.at(i).V;
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> J = motion.J.col(c);
      by_q[c] = power<S>(G, J);
      by_qdot[c] = power<S>(a, cross_twist<S>(V_sum, J)) + b[0] * J[0] + b[1] * J[1] + b[2] * J[2];
      by_a[c] = power<S>(a, J);
      if (node.motion == MotionKind::kExponential) {
        const ExponentialMotion<S>& extra = motion.exponential(i);
        const auto e = static_cast<std::size_t>(c - node.coordinates.begin);
        by_q[c] += a.dot(cross_twist<S>(V_sum, extra.W[e]) + extra.U[e]) +
                   b.dot(extra.W[e].template head<3>());
        by_qdot[c] += a.dot(extra.Z[e]);
        for (std::size_t l = 0; l < 3; ++l) {
          by_q[c] += z[node.coordinates.begin + static_cast<int>(l)] * extra.dJ[e][l].dot(below.F);
        }
      }
    }
    if (node.parent >= 0) {
      wrench_sums_[static_cast<std::size_t>(node.parent)] += wrench_sums_[k];
      coriolis_sums_[static_cast<std::size_t>(node.parent)] += coriolis_sums_[k];
    } else {
      by_gravity_ -= wrench_sums_[k].template tail<3>();
    }
  }
}

template <Scalar S>
Vector6<S> Pullback<S>::body_frame(const Model& model, const Motion<S>& motion,
                                   const Dynamics<S>& dynamics, int link) const {
  const int i = model.node_of_link(link);
  const BodyDynamics<S>& body = dynamics.of_link(link);
  const Vector6<S>& W = twist(i);
  return displacement_covector<S>(motion.at(i), body.I * W, body.B.transposed_times(W), W, body.F);
}

template class Pullback<double>;
template class Pullback<Dual>;

}  // namespace hbar
