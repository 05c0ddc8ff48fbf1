#include "hbar/core/dynamics/dynamics.h"

namespace hbar {
namespace {

/// Rate of momentum of a body: F = I A + V ×* (I V).
template <Scalar S>
inline Vector6<S> momentum_rate(const SpatialInertia<S>& I, const NodeMotion<S>& motion,
                                const Vector6<S>& momentum) {
  return sum<S>(I * motion.A, cross_wrench<S>(motion.V, momentum));
}

template <Scalar S>
inline SpatialInertia<S> world_inertia(const Mechanism<S>& mechanism, const NodeMotion<S>& motion,
                                       int link) {
  return transformed<S>({motion.R, motion.p}, mechanism.inertia[static_cast<std::size_t>(link)]);
}

/// τ_l = J_lᵀ F^C for the coordinates of a node.
template <Scalar S>
void project(const Node& node, const Motion<S>& motion, const Vector6<S>& F,
             Eigen::Ref<VectorX<S>>& tau) {
  for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
    tau[c] = power<S>(F, motion.J.col(c));
  }
}

}  // namespace

template <Scalar S>
Dynamics<S>::Dynamics(const Model& model)
    : bodies(static_cast<std::size_t>(model.link_count())),
      subtree(static_cast<std::size_t>(model.tree().node_count())),
      IJ(Matrix6X<S>::Zero(6, model.dof())),
      BJ(Eigen::Matrix<S, 3, Eigen::Dynamic>::Zero(3, model.dof())) {}

template <Scalar S>
void inverse_dynamics(const Model& model, const Mechanism<S>& mechanism, const Motion<S>& motion,
                      Dynamics<S>& dynamics, Eigen::Ref<VectorX<S>> tau,
                      std::span<const Vector6<S>> wrenches) {
  const Tree& tree = model.tree();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    Vector6<S>& F = dynamics.subtree[static_cast<std::size_t>(i)].F;
    if (node.last) {
      const NodeMotion<S>& self = motion.at(i);
      const SpatialInertia<S> I = world_inertia(mechanism, self, node.link);
      F = momentum_rate<S>(I, self, I * self.V);
      if (!wrenches.empty()) {
        F -= wrenches[static_cast<std::size_t>(node.link)];
      }
    } else {
      F.setZero();
    }
  }
  for (int i = tree.node_count(); i-- > 0;) {
    const Node& node = tree.node(i);
    const Vector6<S>& F = dynamics.below(i).F;
    project<S>(node, motion, F, tau);
    if (node.parent >= 0) {
      dynamics.subtree[static_cast<std::size_t>(node.parent)].F += F;
    }
  }
}

template <Scalar S>
void subtree_dynamics(const Model& model, const Mechanism<S>& mechanism, const Motion<S>& motion,
                      Dynamics<S>& dynamics, Eigen::Ref<VectorX<S>> tau,
                      std::span<const Vector6<S>> wrenches) {
  const Tree& tree = model.tree();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    BodyDynamics<S>& below = dynamics.subtree[static_cast<std::size_t>(i)];
    if (node.last) {
      const NodeMotion<S>& self = motion.at(i);
      BodyDynamics<S>& body = dynamics.bodies[static_cast<std::size_t>(node.link)];
      body.I = world_inertia(mechanism, self, node.link);
      const Vector6<S> momentum = body.I * self.V;
      body.F = momentum_rate<S>(body.I, self, momentum);
      if (!wrenches.empty()) {
        body.F -= wrenches[static_cast<std::size_t>(node.link)];
      }
      body.B = coriolis_operator<S>(body.I, self.V, momentum);
      below = body;
    } else {
      below.I = {};
      below.B = {};
      below.F.setZero();
    }
  }
  for (int i = tree.node_count(); i-- > 0;) {
    const Node& node = tree.node(i);
    const BodyDynamics<S>& below = dynamics.below(i);
    project<S>(node, motion, below.F, tau);
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> J = motion.J.col(c);
      dynamics.IJ.col(c) = below.I * J;
      dynamics.BJ.col(c) = below.B.transposed_times(J);
    }
    if (node.parent >= 0) {
      BodyDynamics<S>& above = dynamics.subtree[static_cast<std::size_t>(node.parent)];
      above.I += below.I;
      above.B += below.B;
      above.F += below.F;
    }
  }
}

template <Scalar S>
void mass_matrix(const Model& model, const Motion<S>& motion, const Dynamics<S>& dynamics,
                 Eigen::Ref<MatrixX<S>> M) {
  const Tree& tree = model.tree();
  M.setZero();
  for (int l = 0; l < tree.dof(); ++l) {
    const int i = tree.node_of(l);
    const auto couple = [&](int c) {
      const S entry = dynamics.IJ.col(l).dot(motion.J.col(c));
      M(l, c) = entry;
      M(c, l) = entry;
    };
    for (const CoordinateRange& range : tree.ancestors(i)) {
      for (int c = range.begin; c < range.end; ++c) {
        couple(c);
      }
    }
    for (int c = tree.node(i).coordinates.begin; c <= l; ++c) {
      couple(c);
    }
  }
}

#define HBAR_INSTANTIATE(S)                                                           \
  template struct Dynamics<S>;                                                        \
  template void inverse_dynamics(const Model&, const Mechanism<S>&, const Motion<S>&, \
                                 Dynamics<S>&, Eigen::Ref<VectorX<S>>,                \
                                 std::span<const Vector6<S>>);                        \
  template void subtree_dynamics(const Model&, const Mechanism<S>&, const Motion<S>&, \
                                 Dynamics<S>&, Eigen::Ref<VectorX<S>>,                \
                                 std::span<const Vector6<S>>);                        \
  template void mass_matrix(const Model&, const Motion<S>&, const Dynamics<S>&,       \
                            Eigen::Ref<MatrixX<S>>);
HBAR_INSTANTIATE(double)
HBAR_INSTANTIATE(Dual)
#undef HBAR_INSTANTIATE

}  // namespace hbar
