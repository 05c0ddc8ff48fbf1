#include "hbar/core/dynamics/columns.h"

namespace hbar {
namespace {

/// Adds a node's coordinates to the ranges that end before them.
void append(std::vector<CoordinateRange>& ranges, CoordinateRange next) {
  if (next.begin == next.end) {
    return;
  }
  if (!ranges.empty() && ranges.back().end == next.begin) {
    ranges.back().end = next.end;
  } else {
    ranges.push_back(next);
  }
}

/// y[i] = Σ_k x[k] columns[k][i] for a run of rows i, with `stride` between columns.
template <int Count, Scalar S>
void multiply_rows(const S* __restrict columns, Eigen::Index stride, const S* __restrict x,
                   CoordinateRange rows, S* __restrict y) {
  for (int i = rows.begin; i < rows.end; ++i) {
    S sum = x[0] * columns[i];
    for (int k = 1; k < Count; ++k) {
      sum += x[k] * columns[k * stride + i];
    }
    y[i] = sum;
  }
}

}  // namespace

template <Scalar S>
Columns<S>::Columns(const Tree& tree)
    : below_(static_cast<std::size_t>(tree.node_count())),
      psi_dot_(Matrix6X<S>::Zero(6, tree.dof())),
      psi_ddot_(Matrix6X<S>::Zero(6, tree.dof())),
      psi_ddot_by_rate_(Matrix6X<S>::Zero(6, tree.dof())),
      rows_above_(tree.dof(), 6),
      rows_below_(tree.dof(), 9) {
  rows_above_.setZero();
  rows_below_.setZero();
  for (int i = 0; i < tree.node_count(); ++i) {
    if (tree.node(i).coordinates.begin == tree.node(i).coordinates.end) {
      continue;  // a long chain of fixed joints is not climbed from each of them
    }
    for (int above = i; above >= 0; above = tree.node(above).parent) {
      append(below_[static_cast<std::size_t>(above)], tree.node(i).coordinates);
    }
  }
}

template <Scalar S>
void Columns<S>::prepare(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics) {
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    if (node.coordinates.begin == node.coordinates.end) {
      continue;
    }
    const NodeMotion<S>& parent = motion.parent_of(node);
    const Vector6<S> V_sum = parent.V + motion.at(i).V;
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> D = motion.J.col(c);
      const FrameDisplacement<S> by_q = frame_displacement<S>(parent, D);
      psi_dot_.col(c) = by_q.psi_dot;
      psi_ddot_.col(c) = by_q.psi_ddot;
      psi_ddot_by_rate_.col(c) = cross_twist<S>(V_sum, D);
      if (node.motion == MotionKind::kExponential) {
        const ExponentialMotion<S>& extra = motion.exponential(i);
        const auto k = static_cast<std::size_t>(c - node.coordinates.begin);
        psi_dot_.col(c) += extra.W[k];
        psi_ddot_.col(c) += cross_twist<S>(V_sum, extra.W[k]) + extra.U[k];
        psi_ddot_by_rate_.col(c) += extra.Z[k];
      }
    }
  }
  rows_above_ = motion.J.transpose();
  rows_below_.template leftCols<6>() = dynamics.IJ.transpose();
  rows_below_.template rightCols<3>() = dynamics.BJ.transpose();
}

template <Scalar S>
void Columns<S>::project(const Tree& tree, const Motion<S>& motion, const Dynamics<S>& dynamics,
                         const JacobianWeights<S>& weights, Eigen::Ref<MatrixX<S>> jacobian) const {
  jacobian.setZero();
  const Eigen::Index n = tree.dof();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const BodyDynamics<S>& below = dynamics.below(i);
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> D = motion.J.col(c);
      const Vector6<S> psi_dot = weights.q * psi_dot_.col(c) + weights.v * D;
      const Vector6<S> psi_ddot =
          weights.q * psi_ddot_.col(c) + weights.v * psi_ddot_by_rate_.col(c) + weights.a * D;
      const Vector6<S> wrench =
          sum<S>(below.I * psi_ddot, below.B * psi_dot, cross_wrench<S>(weights.q * D, below.F));
      // Only the angular half of Ψ̇ matters for B^C in the rows below.
      Eigen::Matrix<S, 9, 1> below_weights;
      below_weights.template head<6>() = psi_ddot;
      below_weights.template tail<3>() = psi_dot.template head<3>();
      S* column = jacobian.col(c).data();
      for (const CoordinateRange& rows : tree.ancestors(i)) {
        multiply_rows<6>(rows_above_.data(), n, wrench.data(), rows, column);
      }
      for (const CoordinateRange& rows : below_[static_cast<std::size_t>(i)]) {
        multiply_rows<9>(rows_below_.data(), n, below_weights.data(), rows, column);
      }
      if (node.motion == MotionKind::kExponential) {
        const auto k = static_cast<std::size_t>(c - node.coordinates.begin);
        for (int l = 0; l < 3; ++l) {
          column[node.coordinates.begin + l] +=
              weights.q * motion.exponential(i).dJ[k][static_cast<std::size_t>(l)].dot(below.F);
        }
      }
    }
  }
}

template class Columns<double>;
template class Columns<Dual>;

}  // namespace hbar
