#include "hbar/contact/tactile.h"

#include <algorithm>

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
TactileReadings<S>::TactileReadings(const Model& model) : model_(model), links_(model) {
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

/// Visits the touching points: visit(side, pair, index of the point, TouchingPoint).
template <Scalar S>
template <typename Visit>
void TactileReadings<S>::for_each_touch(const Mechanism<S>& mechanism, const Motion<S>& motion,
                                        const Visit& visit) const {
  for (const Side& side : sides_) {
    const Contact& contact = side.contact;
    const TactileSensor& sensor = model_.tactile_sensors()[static_cast<std::size_t>(side.sensor)];
    const PairMotion<S> pair = {body_motion<S>(model_, mechanism, motion, contact.link),
                                body_motion<S>(model_, mechanism, motion, contact.other)};
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
  Vector6<S> by_twist_of_b = -by_twist;
  if (reaction == Reaction::kSurface) {
    by_twist_of_b.template head<3>() += (point.d * point.n).cross(by_u);
  }
  links_.add_to_body(side.contact.link, by_displacement, by_twist);
  links_.add_to_body(side.contact.other, -by_displacement, by_twist_of_b);
}

template <Scalar S>
void TactileReadings<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                   const VectorView<S>& p, const Motion<S>& motion,
                                   const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                                   Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> grad_p) {
  links_.clear();
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
  links_.sum();
  links_.add_coordinates(motion, by_q);
  links_.add_rates(motion, by_qdot);
  links_.add_frames(mechanism, set, p, motion, grad_p);
}

template class TactileReadings<double>;
template class TactileReadings<Dual>;

}  // namespace hbar
