#include "hbar/core/columns.h"

namespace hbar {

template <Scalar S>
Columns<S>::Columns(const Tree& tree)
    : J_(tree.dof(), 6),
      psi_ddot_(tree.dof(), 6),
      psi_dot_(tree.dof(), 3),
      ancestor_wrench_(6, tree.dof()) {
  J_.setZero();
  psi_ddot_.setZero();
  psi_dot_.setZero();
  ancestor_wrench_.setZero();
}

template <Scalar S>
void Columns<S>::prepare(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
                         const JacobianWeights<S>& weights) {
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    if (node.coordinates.begin == node.coordinates.end) {
      continue;
    }
    const NodeMotion<S>& parent = motion.parent_of(node);
    const Vector6<S> V_sum = parent.V + motion.at(i).V;
    const BodyDynamics<S>& below = dynamics.below(i);
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> D = motion.J.col(c);
      const FrameDisplacement<S> by_q = frame_displacement<S>(parent, D);
      Vector6<S> psi_dot = by_q.psi_dot;
      Vector6<S> psi_ddot = by_q.psi_ddot;
      Vector6<S> by_rate = cross_twist<S>(V_sum, D);
      if (node.motion == MotionKind::kExponential) {
        const ExponentialMotion<S>& extra = motion.exponential(i);
        const auto k = static_cast<std::size_t>(c - node.coordinates.begin);
        psi_dot += extra.W[k];
        psi_ddot += cross_twist<S>(V_sum, extra.W[k]) + extra.U[k];
        by_rate += extra.Z[k];
      }
      const Vector6<S> first = weights.q * psi_dot + weights.v * D;
      const Vector6<S> second = weights.q * psi_ddot + weights.v * by_rate + weights.a * D;
      ancestor_wrench_.col(c) =
          below.I * second + below.B * first + weights.q * cross_wrench<S>(D, below.F);
      J_.row(c) = D.transpose();
      psi_ddot_.row(c) = second.transpose();
      psi_dot_.row(c) = first.template head<3>().transpose();
    }
  }
}

namespace {

/// y[i] = Σ_k x[k] columns[k][i] for i in a range, with `stride` between columns and
/// `y_stride` between results.
template <int Count, Scalar S>
void accumulate(const S* columns, Eigen::Index stride, const S* x, int begin, int end, S* y) {
  for (int i = begin; i < end; ++i) {
    S sum = x[0] * columns[i];
    for (int k = 1; k < Count; ++k) {
      sum += x[k] * columns[k * stride + i];
    }
    y[i] += sum;
  }
}

}  // namespace

template <Scalar S>
void Columns<S>::combine(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
                         const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> jacobian) {
  prepare(tree, motion, dynamics, weights);
  jacobian.setZero();
  const Eigen::Index n = tree.dof();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    for (int l = node.coordinates.begin; l < node.coordinates.end; ++l) {
      const S* IJ = dynamics.IJ.col(l).data();
      const S* BJ = dynamics.BJ.col(l).data();
      const S* wrench = ancestor_wrench_.col(l).data();
      for (const CoordinateRange& range : tree.ancestors(i)) {
        for (int c = range.begin; c < range.end; ++c) {
          jacobian(l, c) = psi_ddot_.row(c).dot(Eigen::Map<const Vector6<S>>(IJ)) +
                           psi_dot_.row(c).dot(Eigen::Map<const Vector3<S>>(BJ));
        }
        accumulate<6>(J_.data(), n, wrench, range.begin, range.end, jacobian.col(l).data());
      }
      for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
        jacobian(l, c) = psi_ddot_.row(c).dot(Eigen::Map<const Vector6<S>>(IJ)) +
                         psi_dot_.row(c).dot(Eigen::Map<const Vector3<S>>(BJ));
        if (node.motion == MotionKind::kExponential) {
          const auto k = static_cast<std::size_t>(c - node.coordinates.begin);
          const auto r = static_cast<std::size_t>(l - node.coordinates.begin);
          jacobian(l, c) += weights.q * motion.exponential(i).dJ[k][r].dot(dynamics.below(i).F);
        }
      }
    }
  }
}

template class Columns<double>;
template class Columns<Dual>;

}  // namespace hbar
