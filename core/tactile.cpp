#include "hbar/core/tactile.h"

#include <algorithm>

#include "hbar/core/parameter_derivatives.h"

namespace hbar {
namespace {

/// Whether two contacts ask for the same distance; with and without caps it is one.
bool share_distance(const Contact& a, const Contact& b) {
  const bool own =
      std::holds_alternative<OwnShape>(a.surface) && std::holds_alternative<OwnShape>(b.surface);
  return a.other == b.other && (own || a.surface == b.surface);
}

/// Distinct distance sides of a model's contacts that are bodies.
std::vector<Contact> distance_sides(const Model& model) {
  std::vector<Contact> sides;
  for (const Contact& contact : model.contacts()) {
    const bool known = std::any_of(sides.begin(), sides.end(), [&contact](const Contact& other) {
      return share_distance(other, contact);
    });
    if (contact.other >= 0 && !known) {
      sides.push_back(contact);
    }
  }
  return sides;
}

template <Scalar S>
SurfaceDistance<S> surface_of(const Model& model, const Mechanism<S>& mechanism,
                              const Contact& contact) {
  return {contact.surface, model.link(contact.other).body.shape,
          mechanism.sizes.col(contact.other)};
}

}  // namespace

template <Scalar S>
TactileReadings<S>::TactileReadings(const Model& model)
    : model_(model),
      covectors_(model.link_count()),
      by_displacement_(static_cast<std::size_t>(model.tree().node_count())),
      by_twist_(by_displacement_.size()) {
  int first = 0;
  for (int i = 0; i < static_cast<int>(model.tactile_sensors().size()); ++i) {
    const TactileSensor& sensor = model.tactile_sensors()[static_cast<std::size_t>(i)];
    for (const Contact& side : distance_sides(model)) {
      if (side.other != sensor.link) {
        Contact contact;
        contact.link = sensor.link;
        contact.other = side.other;
        contact.surface = side.surface;
        contact.coefficients = sensor.coefficients;
        contact.reaction = side.reaction;
        sides_.push_back({i, first, contact});
      }
    }
    first += 3 * static_cast<int>(sensor.points.cols());
  }
}

template <Scalar S>
PairMotion<S> TactileReadings<S>::pair_motion(const Mechanism<S>& mechanism,
                                              const Motion<S>& motion,
                                              const Contact& contact) const {
  const auto body = [&](int link) -> BodyMotion<S> {
    const NodeMotion<S>& joint = motion.at(model_.node_of_link(link));
    return {RigidTransform<S>{joint.R, joint.p} * mechanism.X_JB[static_cast<std::size_t>(link)],
            joint.V};
  };
  return {body(contact.link), body(contact.other)};
}

/// Visits the touching points: visit(side, pair, index of the point, TouchingPoint).
template <Scalar S>
template <typename Visit>
void TactileReadings<S>::for_each_touch(const Mechanism<S>& mechanism, const Motion<S>& motion,
                                        const Visit& visit) const {
  for (const Side& side : sides_) {
    const Contact& contact = side.contact;
    const TactileSensor& sensor = model_.tactile_sensors()[static_cast<std::size_t>(side.sensor)];
    const PairMotion<S> pair = pair_motion(mechanism, motion, contact);
    const SurfaceDistance<S> surface = surface_of<S>(model_, mechanism, contact);
    const RigidTransform<S> X_BA = inverse(pair.b.X_WB) * pair.a.X_WB;
    const ContactCoefficients& c = contact.coefficients;
    const LawNumbers<S> numbers = {S(c.kn), S(c.kt), S(c.mu), S(c.damping),
                                   mechanism.contact_scale[contact.link]};
    for (int i = 0; i < static_cast<int>(sensor.points.cols()); ++i) {
      const Vector3<S> x_A = sensor.points.col(i).template cast<S>();
      const Vector3<S> x_B = X_BA.R * x_A + X_BA.p;
      const Eigen::Vector3d place = x_B.unaryExpr([](const S& entry) { return value_of(entry); });
      if (surface.touches(surface.lower_bound(place))) {
        TouchingPoint<S> touching;
        compute_touch<S>(contact, numbers, surface, pair, i, x_A, S(0.0), TouchDetail::kDerivatives,
                         touching);
        visit(side, pair, i, touching);
      }
    }
  }
}

/// Directions of a point's three readings in the world, as columns.
template <Scalar S>
Matrix3<S> TactileReadings<S>::world_axes(const PairMotion<S>& pair, int sensor, int point) const {
  const TactileSensor& owner = model_.tactile_sensors()[static_cast<std::size_t>(sensor)];
  Eigen::Matrix3d axes;
  const Eigen::Vector3d axis0 = owner.axis0.col(point);
  const Eigen::Vector3d axis1 = owner.axis1.col(point);
  axes << axis0, axis1, -axis0.cross(axis1);
  return pair.a.X_WB.R * axes.cast<S>();
}

template <Scalar S>
void TactileReadings<S>::readings(const Mechanism<S>& mechanism, const Motion<S>& motion,
                                  Eigen::Ref<VectorX<S>> out) const {
  out.setZero();
  for_each_touch(
      mechanism, motion,
      [&](const Side& side, const PairMotion<S>& pair, int i, const TouchingPoint<S>& point) {
        out.template segment<3>(side.first + 3 * i) +=
            world_axes(pair, side.sensor, i).transpose() * point.force.f;
      });
}

/// Covectors of weight·f on both bodies, the weight being carried along with A.
template <Scalar S>
void TactileReadings<S>::add_point(const Side& side, const PairMotion<S>& pair,
                                   const TouchingPoint<S>& point, const Vector3<S>& weight) {
  const Reaction reaction = side.contact.reaction;
  const Vector3<S> by_x = point_slopes<S>(reaction, pair, point).force.transpose() * weight;
  const Vector3<S> by_u = point.law.by_u.transpose() * weight;
  const Vector6<S> by_twist = spatial<S>(point.x.cross(by_u), by_u);
  // What the force loses by turning with B instead of with A; formulation §6.
  const Vector3<S> turned = point.x.cross(by_x) - point.force.f.cross(weight);
  const Vector6<S> by_displacement =
      sum<S>(spatial<S>(turned, by_x), cross_wrench<S>(pair.a.V, by_twist));
  const auto a = static_cast<std::size_t>(side.contact.link);
  const auto b = static_cast<std::size_t>(side.contact.other);
  covectors_.by_displacement[a] += by_displacement;
  covectors_.by_displacement[b] -= by_displacement;
  covectors_.by_twist[a] += by_twist;
  covectors_.by_twist[b] -= by_twist;
  if (reaction == Reaction::kSurface) {
    covectors_.by_twist[b].template head<3>() += (point.d * point.n).cross(by_u);
  }
}

/// Sums covectors along the tree and projects them on the coordinates.
template <Scalar S>
void TactileReadings<S>::sum_nodes(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_q,
                                   Eigen::Ref<VectorX<S>> by_qdot) {
  const Tree& tree = model_.tree();
  for (std::size_t i = 0; i < by_twist_.size(); ++i) {
    by_displacement_[i].setZero();
    by_twist_[i].setZero();
  }
  for (int link = 0; link < model_.link_count(); ++link) {
    const auto node = static_cast<std::size_t>(model_.node_of_link(link));
    by_displacement_[node] = covectors_.by_displacement[static_cast<std::size_t>(link)];
    by_twist_[node] = covectors_.by_twist[static_cast<std::size_t>(link)];
  }
  for (int i = tree.node_count(); i-- > 0;) {
    const Node& node = tree.node(i);
    const auto k = static_cast<std::size_t>(i);
    const Vector6<S>& V = motion.parent_of(node).V;
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      const Vector6<S> J = motion.J.col(c);
      by_q[c] += power<S>(by_displacement_[k], J) + power<S>(by_twist_[k], cross_twist<S>(V, J));
      by_qdot[c] += power<S>(by_twist_[k], J);
      if (node.motion == MotionKind::kExponential) {
        const auto e = static_cast<std::size_t>(c - node.coordinates.begin);
        by_q[c] += by_twist_[k].dot(motion.exponential(i).W[e]);
      }
    }
    if (node.parent >= 0) {
      by_displacement_[static_cast<std::size_t>(node.parent)] += by_displacement_[k];
      by_twist_[static_cast<std::size_t>(node.parent)] += by_twist_[k];
    }
  }
}

template <Scalar S>
void TactileReadings<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                   const VectorView<S>& p, const Motion<S>& motion,
                                   const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                                   Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> grad_p) {
  for (std::size_t i = 0; i < covectors_.by_twist.size(); ++i) {
    covectors_.by_displacement[i].setZero();
    covectors_.by_twist[i].setZero();
  }
  for_each_touch(
      mechanism, motion,
      [&](const Side& side, const PairMotion<S>& pair, int i, const TouchingPoint<S>& point) {
        const Vector3<S> weight =
            world_axes(pair, side.sensor, i) * y.template segment<3>(side.first + 3 * i);
        add_point(side, pair, point, weight);
        const int scale = set.index(ParameterKind::kContactScale, side.contact.link, 0);
        if (scale >= 0) {
          grad_p[scale] += weight.dot(point.law.by_scale);
        }
        const SurfaceDistance<S> surface = surface_of<S>(model_, mechanism, side.contact);
        for (int k = 0; k < surface.size_count(); ++k) {
          const int index = set.index(ParameterKind::kSize, side.contact.other, k);
          if (index >= 0) {
            const SizeRate<S> rate = surface.by_size(point.lever_B, k);
            const PointChange<S> by = {.d = rate.d, .n = pair.b.X_WB.R * rate.n};
            grad_p[index] += weight.dot(
                wrench_change<S>(side.contact.reaction, pair, point, by).on_a.template tail<3>());
          }
        }
      });
  sum_nodes(motion, by_q, by_qdot);
  for (const ParameterBlock& block : set.blocks()) {
    if (block.kind == ParameterKind::kJointTransform) {
      const int first = first_node_of_link(model_, block.owner);
      const auto k = static_cast<std::size_t>(first);
      const Vector6<S> G =
          sum<S>(by_displacement_[k],
                 cross_wrench<S>(-motion.parent_of(model_.tree().node(first)).V, by_twist_[k]));
      add_frame_gradient<S>(model_, mechanism, motion, set, block, p, G, grad_p);
    } else if (block.kind == ParameterKind::kBodyTransform) {
      const auto k = static_cast<std::size_t>(block.owner);
      const Vector6<S> G = sum<S>(
          covectors_.by_displacement[k],
          cross_wrench<S>(-motion.at(model_.node_of_link(block.owner)).V, covectors_.by_twist[k]));
      add_frame_gradient<S>(model_, mechanism, motion, set, block, p, G, grad_p);
    }
  }
}

template class TactileReadings<double>;
template TactileReadings<Dual>::TactileReadings(const Model&);
template void TactileReadings<Dual>::readings(const Mechanism<Dual>&, const Motion<Dual>&,
                                              Eigen::Ref<VectorX<Dual>>) const;

}  // namespace hbar
