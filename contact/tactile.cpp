#include "hbar/contact/tactile.h"

#include <algorithm>

namespace hbar {
namespace {

/// Whether two contacts use the same distance; caps make no difference.
bool share_distance(const Contact& a, const Contact& b) {
  const bool own =
      std::holds_alternative<OwnShape>(a.surface) && std::holds_alternative<OwnShape>(b.surface);
  return a.other == b.other && (own || a.surface == b.surface);
}

/// The distinct surface sides of a model's contacts that are bodies.
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

/// Covectors on both bodies of weight·f, with the weight carried along with A.
template <Scalar S>
void add_covectors(const Contact& contact, const PairMotion<S>& pair, const TouchingPoint<S>& point,
                   const Vector3<S>& weight, LinkPullback<S>& links) {
  const Vector3<S> by_x = point_slopes<S>(contact.reaction, pair, point).force.transpose() * weight;
  const Vector3<S> by_u = point.law.by_u.transpose() * weight;
  const Vector6<S> by_twist = spatial<S>(point.x.cross(by_u), by_u);
  // Correction because the force turns with B rather than with A.
  const Vector3<S> turned = point.x.cross(by_x) - point.force.f.cross(weight);
  const Vector6<S> by_displacement =
      sum<S>(spatial<S>(turned, by_x), cross_wrench<S>(pair.a.V, by_twist));
  Vector6<S> by_twist_of_b = -by_twist;
  if (contact.reaction == Reaction::kSurface) {
    by_twist_of_b.template head<3>() += (point.d * point.n).cross(by_u);
  }
  links.add_to_body(contact.link, by_displacement, by_twist);
  links.add_to_body(contact.other, -by_displacement, by_twist_of_b);
}

}  // namespace

template <Scalar S>
TactileReadings<S>::TactileReadings(const Model& model) : model_(model) {
  std::size_t points = 0;
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
        sides_.push_back({i, contact, {}});
        points += static_cast<std::size_t>(sensor.points.cols());
      }
    }
  }
  touches_.reserve(std::min(points, kReservedTouches));
}

template <Scalar S>
void TactileReadings<S>::linearize(const Mechanism<S>& mechanism, const Motion<S>& motion) {
  touches_.clear();
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    Side& side = sides_[s];
    const Contact& contact = side.contact;
    const TactileSensor& sensor = model_.tactile_sensors()[static_cast<std::size_t>(side.sensor)];
    side.motion = {body_motion<S>(model_, mechanism, motion, contact.link),
                   body_motion<S>(model_, mechanism, motion, contact.other)};
    const SurfaceDistance<S> surface = surface_of<S>(model_, mechanism, contact);
    const RigidTransform<S> X_BA = inverse(side.motion.b.X_WB) * side.motion.a.X_WB;
    const ContactCoefficients& c = contact.coefficients;
    const LawNumbers<S> numbers = {S(c.kn), S(c.kt), S(c.mu), S(c.damping),
                                   mechanism.contact_scale[contact.link]};
    for (int i = 0; i < static_cast<int>(sensor.points.cols()); ++i) {
      const Vector3<S> x_A = sensor.points.col(i).template cast<S>();
      const Vector3<S> x_B = X_BA.R * x_A + X_BA.p;
      const Eigen::Vector3d place = x_B.unaryExpr([](const S& entry) { return value_of(entry); });
      if (surface.touches(surface.lower_bound(place))) {
        touches_.push_back({s, {}});
        compute_touch<S>(contact, numbers, surface, side.motion, i, x_A, S(0.0),
                         TouchDetail::kDerivatives, touches_.back().point);
      }
    }
  }
}

/// Directions of a point's three readings in the world, as columns.
template <Scalar S>
Matrix3<S> TactileReadings<S>::world_axes(const Side& side, int point) const {
  const TactileSensor& owner = model_.tactile_sensors()[static_cast<std::size_t>(side.sensor)];
  Eigen::Matrix3d axes;
  const Eigen::Vector3d axis0 = owner.axis0.col(point);
  const Eigen::Vector3d axis1 = owner.axis1.col(point);
  axes << axis0, axis1, -axis0.cross(axis1);
  return side.motion.a.X_WB.R * axes.cast<S>();
}

template <Scalar S>
void TactileReadings<S>::read(int sensor, Eigen::Ref<VectorX<S>> out) const {
  out.setZero();
  for (const auto& [s, point] : touches_) {
    if (sides_[s].sensor == sensor) {
      out.template segment<3>(3 * point.index) +=
          world_axes(sides_[s], point.index).transpose() * point.force.f;
    }
  }
}

/// The effect of a weight on a point's force on its scale, and on the sizes of the surface it
/// senses.
template <Scalar S>
void TactileReadings<S>::add_parameters(const Side& side, const TouchingPoint<S>& point,
                                        const Vector3<S>& weight, const Applied<S>& applied,
                                        Eigen::Ref<VectorX<S>>& grad_p) const {
  const Contact& contact = side.contact;
  const int scale = applied.set.index(ParameterKind::kContactScale, contact.link, 0);
  if (scale >= 0) {
    grad_p[scale] += weight.dot(point.law.by_scale);
  }
  const SurfaceDistance<S> surface = surface_of<S>(model_, applied.mechanism, contact);
  for (int k = 0; k < surface.size_count(); ++k) {
    const int index = applied.set.index(ParameterKind::kSize, contact.other, k);
    if (index >= 0) {
      const SizeRate<S> rate = surface.by_size(point.lever_B, k);
      const PointChange<S> by = {.d = rate.d, .n = side.motion.b.X_WB.R * rate.n};
      grad_p[index] += weight.dot(
          wrench_change<S>(contact.reaction, side.motion, point, by).on_a.template tail<3>());
    }
  }
}

template <Scalar S>
void TactileReadings<S>::pull_back(int sensor, const VectorView<S>& y, const Applied<S>& applied,
                                   LinkPullback<S>& links, Eigen::Ref<VectorX<S>> grad_p) const {
  for (const auto& [s, point] : touches_) {
    const Side& side = sides_[s];
    if (side.sensor == sensor) {
      const Vector3<S> weight =
          world_axes(side, point.index) * y.template segment<3>(3 * point.index);
      add_covectors<S>(side.contact, side.motion, point, weight, links);
      add_parameters(side, point, weight, applied, grad_p);
    }
  }
}

template class TactileReadings<double>;
template class TactileReadings<Dual>;

}  // namespace hbar
