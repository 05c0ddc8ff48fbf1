#include "hbar/core/dynamics/motion.h"

#include "hbar/core/base/rotation.h"

namespace hbar {
namespace {

/// Turns a frame about a world axis, of which `axis` are the coordinates in the
/// frame.
template <Scalar S>
void turn(const Vector3<S>& world_axis, const Eigen::Vector3d& axis, const S& angle,
          Matrix3<S>& R) {
  using std::cos;
  using std::sin;
  const S c = cos(angle);
  const Vector3<S> along = (1.0 - c) * world_axis;
  const Vector3<S> across = sin(angle) * world_axis;
  for (int k = 0; k < 3; ++k) {
    const Vector3<S> e = R.col(k);
    R.col(k) = c * e + across.cross(e) + axis[k] * along;
  }
}

/// A node whose motion has one constant axis: rotation or translation.
template <Scalar S>
void move_along_axis(const Node& node, const NodeMotion<S>& parent, const S& q, const S& qdot,
                     const S& a, NodeMotion<S>& self, Motion<S>& motion) {
  const Vector3<S> axis = self.R * node.axis.template cast<S>();
  Vector6<S> J;
  if (node.motion == MotionKind::kRotation) {
    turn<S>(axis, node.axis, q, self.R);
    J = spatial<S>(axis, self.p.cross(axis));
  } else {
    self.p += axis * q;
    J = spatial<S>(Vector3<S>::Zero(), axis);
  }
  motion.J.col(node.coordinates.begin) = J;
  Vector6<S> rate;
  Vector6<S> rate_dot;
  for (int i = 0; i < 6; ++i) {
    rate[i] = J[i] * qdot;
    rate_dot[i] = J[i] * a;
  }
  self.V = sum<S>(parent.V, rate);
  self.A = sum<S>(parent.A, rate_dot, cross_twist<S>(parent.V, rate));
}

/// World twist of an angular velocity given in a frame's own axes and acting at
/// its origin.
template <Scalar S>
Vector6<S> at_frame(const NodeMotion<S>& frame, const Vector3<S>& omega) {
  const Vector3<S> w = frame.R * omega;
  return spatial<S>(w, frame.p.cross(w));
}

template <Scalar S>
void move_exponentially(const Node& node, const NodeMotion<S>& parent, const Vector3<S>& r,
                        const Vector3<S>& rate, const Vector3<S>& rate_dot, NodeMotion<S>& self,
                        ExponentialMotion<S>& extra, Motion<S>& motion) {
  self.R = self.R * exp_rotation(r);
  const ExponentialRates<S> k = exponential_rates(r, rate, rate_dot);
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    motion.J.col(node.coordinates.begin + c) = at_frame<S>(self, k.J.col(c));
    extra.W[i] = at_frame<S>(self, k.d_velocity_dr.col(c));
    extra.U[i] = at_frame<S>(self, k.d_acceleration_dr.col(c));
    extra.Z[i] = at_frame<S>(self, k.d_acceleration_drate.col(c));
    for (int l = 0; l < 3; ++l) {
      extra.dJ[i][static_cast<std::size_t>(l)] = at_frame<S>(self, k.dJ_dr[i].col(l));
    }
  }
  const Vector6<S> velocity = at_frame<S>(self, k.J * rate);
  self.V = parent.V + velocity;
  self.A = parent.A + at_frame<S>(self, k.J * rate_dot + k.J_dot_rate) +
           cross_twist<S>(parent.V, velocity);
}

}  // namespace

template <Scalar S>
Motion<S>::Motion(const Tree& tree)
    : nodes(static_cast<std::size_t>(tree.node_count())),
      J(Matrix6X<S>::Zero(6, tree.dof())),
      exponential_of(static_cast<std::size_t>(tree.node_count()), -1) {
  world.R.setIdentity();
  world.p.setZero();
  world.V.setZero();
  world.A.setZero();
  for (int i = 0; i < tree.node_count(); ++i) {
    if (tree.node(i).motion == MotionKind::kExponential) {
      exponential_of[static_cast<std::size_t>(i)] = static_cast<int>(exponentials.size());
      exponentials.emplace_back();
    }
  }
}

template <Scalar S>
void compute_motion(const Tree& tree, const Mechanism<S>& mechanism, const VectorView<S>& q,
                    const VectorView<S>& qdot, const VectorView<S>& a, Motion<S>& motion) {
  motion.world.A.template tail<3>() = -mechanism.gravity;
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const NodeMotion<S>& parent = motion.parent_of(node);
    NodeMotion<S>& self = motion.nodes[static_cast<std::size_t>(i)];
    if (node.first) {
      const RigidTransform<S>& X_PJ = mechanism.X_PJ[static_cast<std::size_t>(node.link)];
      self.R.noalias() = parent.R * X_PJ.R;
      self.p = parent.p;
      self.p.noalias() += parent.R * X_PJ.p;
    } else {
      self.R = parent.R;
      self.p = parent.p;
    }
    const int c = node.coordinates.begin;
    switch (node.motion) {
      case MotionKind::kFixed:
        self.V = parent.V;
        self.A = parent.A;
        break;
      case MotionKind::kRotation:
      case MotionKind::kTranslation:
        move_along_axis<S>(node, parent, q[c], qdot[c], a[c], self, motion);
        break;
      case MotionKind::kExponential:
        move_exponentially<S>(node, parent, q.template segment<3>(c), qdot.template segment<3>(c),
                              a.template segment<3>(c), self,
                              motion.exponentials[static_cast<std::size_t>(
                                  motion.exponential_of[static_cast<std::size_t>(i)])],
                              motion);
        break;
    }
  }
}

int first_node_of_link(const Model& model, int link) {
  int node = model.node_of_link(link);
  while (!model.tree().node(node).first) {
    node = model.tree().node(node).parent;
  }
  return node;
}

template <Scalar S>
RigidTransform<S> rest_frame(const Model& model, const Mechanism<S>& mechanism,
                             const Motion<S>& motion, int link) {
  const NodeMotion<S>& parent =
      motion.parent_of(model.tree().node(first_node_of_link(model, link)));
  return RigidTransform<S>{parent.R, parent.p} * mechanism.X_PJ[static_cast<std::size_t>(link)];
}

template struct Motion<double>;
template struct Motion<Dual>;
template void compute_motion(const Tree&, const Mechanism<double>&, const VectorView<double>&,
                             const VectorView<double>&, const VectorView<double>&, Motion<double>&);
template void compute_motion(const Tree&, const Mechanism<Dual>&, const VectorView<Dual>&,
                             const VectorView<Dual>&, const VectorView<Dual>&, Motion<Dual>&);
template RigidTransform<double> rest_frame(const Model&, const Mechanism<double>&,
                                           const Motion<double>&, int);
template RigidTransform<Dual> rest_frame(const Model&, const Mechanism<Dual>&, const Motion<Dual>&,
                                         int);

}  // namespace hbar
