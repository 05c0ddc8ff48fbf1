#pragma once

#include "hbar/contact/contact_forces.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/parameters/applied.h"

namespace hbar {

/// Visits the changes of touching points with a set's parameters at fixed motion, after
/// contacts.linearize: contact points (III), contact scale (VI), coefficients and sizes.
///
/// @param visit  visit(index in p, ActivePair, TouchingPoint, PointChange): one contribution to
///               ∂(point)/∂p; a parameter may be visited any number of times, or never if it
///               affects no touching point
template <Scalar S, typename Visit>
void for_each_point_change(const ContactForces<S>& contacts, const Applied<S>& applied,
                           const Visit& visit) {
  const Model& model = contacts.model();
  const Mechanism<S>& mechanism = applied.mechanism;
  const ParameterSet& set = applied.set;
  for (const ActivePair<S>& pair : contacts.active()) {
    const Contact& contact = model.contact(pair.contact);
    const Body& body = model.link(contact.link).body;
    const int sizes_a = size_count(body.shape);
    const bool resizable = std::holds_alternative<OwnShape>(contact.surface);
    const Shape nothing = NoShape{};
    const Shape& other = resizable ? model.link(contact.other).body.shape : nothing;
    const int size_owner = std::max(contact.other, 0);
    const SurfaceDistance<S> surface(contact.surface, other, mechanism.sizes.col(size_owner));
    const auto changes = [&](int index, const TouchingPoint<S>& point, const PointChange<S>& by) {
      visit(index, pair, point, by);
    };
    const int scale = set.index(ParameterKind::kContactScale, contact.link, 0);
    std::array<int, 4> coefficients = {};
    std::array<int, 3> sizes_of_a = {-1, -1, -1};
    std::array<int, 3> sizes_of_b = {-1, -1, -1};
    for (std::size_t k = 0; k < 4; ++k) {
      coefficients[k] =
          set.index(ParameterKind::kContactCoefficient, pair.contact, static_cast<int>(k));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sizes_of_a[k] = set.index(ParameterKind::kSize, contact.link, static_cast<int>(k));
      sizes_of_b[k] = set.index(ParameterKind::kSize, contact.other, static_cast<int>(k));
    }
    for (const TouchingPoint<S>& point : contacts.points(pair)) {
      if (scale >= 0) {
        changes(scale, point, {.f = point.law.by_scale});
      }
      for (int k = 0; k < 4; ++k) {
        const int index = coefficients[static_cast<std::size_t>(k)];
        if (index >= 0) {
          changes(index, point, {.f = point.law.by_coefficient[static_cast<std::size_t>(k)]});
        }
      }
      for (int k = 0; k < 3 && point.index >= 0; ++k) {
        const int index =
            set.index(ParameterKind::kContactPoint, contact.link, 3 * point.index + k);
        if (index >= 0) {
          changes(index, point, {.x = pair.motion.a.X_WB.R.col(k)});
        }
      }
      for (int k = 0; k < sizes_a; ++k) {
        const int index = sizes_of_a[static_cast<std::size_t>(k)];
        if (index < 0) {
          continue;
        }
        if (point.index < 0) {
          changes(index, point, {.place = -point.n, .d = S(-1.0)});
        } else {
          const Eigen::Vector3d rate =
              surface_point_rate(body.shape, body.contact_points.col(point.index), k);
          changes(index, point, {.x = pair.motion.a.X_WB.R * rate.cast<S>()});
        }
      }
      for (int k = 0; k < surface.size_count(); ++k) {
        const int index = sizes_of_b[static_cast<std::size_t>(k)];
        if (index >= 0) {
          const SizeRate<S> rate = surface.by_size(point.lever_B, k);
          const Vector3<S> n = pair.motion.b.X_WB.R * rate.n;
          // A ball touches where its normal points.
          const S radius = point.index < 0 ? mechanism.sizes(0, contact.link) : S(0.0);
          changes(index, point, {.place = -radius * n, .d = rate.d, .n = n});
        }
      }
    }
  }
}

/// The same for contact wrenches.
///
/// @param visit  visit(index in p, contact, PairWrenches): one contribution to ∂(wrenches)/∂p
template <Scalar S, typename Visit>
void for_each_contact_change(const ContactForces<S>& contacts, const Applied<S>& applied,
                             const Visit& visit) {
  for_each_point_change(contacts, applied,
                        [&](int index, const ActivePair<S>& pair, const TouchingPoint<S>& point,
                            const PointChange<S>& by) {
                          const Contact& contact = contacts.model().contact(pair.contact);
                          visit(index, pair.contact,
                                wrench_change<S>(contact.reaction, pair.motion, point, by));
                        });
}

}  // namespace hbar
