#include "hbar/contact/contact_pair.h"

namespace hbar {
namespace {

/// Where the force acts on B.
template <Scalar S>
Vector3<S> reaction_point(Reaction reaction, const TouchingPoint<S>& point) {
  return reaction == Reaction::kPoint ? point.x : Vector3<S>(point.x - point.d * point.n);
}

/// Wrench of a force at x.
template <Scalar S>
Vector6<S> wrench_at(const Vector3<S>& x, const Vector3<S>& f) {
  return spatial<S>(x.cross(f), f);
}

/// Adds Pᵀ(x) Q P(y) of a 3 x 3 matrix Q, with P(x) η the displacement of x by a twist η.
template <Scalar S>
void add_sandwich(const Vector3<S>& x, const Matrix3<S>& Q, const Vector3<S>& y, Matrix6<S>& out) {
  const Matrix3<S> left = skew<S>(x) * Q;
  const Matrix3<S> Y = skew<S>(y);
  out.template topLeftCorner<3, 3>().noalias() -= left * Y;
  out.template topRightCorner<3, 3>() += left;
  out.template bottomLeftCorner<3, 3>().noalias() -= Q * Y;
  out.template bottomRightCorner<3, 3>() += Q;
}

/// −ad(V): D ↦ D × V.
template <Scalar S>
Matrix6<S> carried_twist(const Vector6<S>& V) {
  Matrix6<S> out;
  const Matrix3<S> w = skew<S>(V.template head<3>());
  out.template topLeftCorner<3, 3>() = -w;
  out.template topRightCorner<3, 3>().setZero();
  out.template bottomLeftCorner<3, 3>() = -skew<S>(V.template tail<3>());
  out.template bottomRightCorner<3, 3>() = -w;
  return out;
}

}  // namespace

template <Scalar S>
void compute_touch(const Contact& contact, const LawNumbers<S>& numbers,
                   const SurfaceDistance<S>& surface, const PairMotion<S>& motion, int index,
                   const Vector3<S>& x_A, const S& radius, TouchDetail how, TouchingPoint<S>& at) {
  at.index = index;
  at.lever = motion.a.X_WB.R * x_A + motion.a.X_WB.p;
  const Matrix3<S>& R = motion.b.X_WB.R;
  at.lever_B = R.transpose() * (at.lever - motion.b.X_WB.p);
  SurfaceSample<S> sample = surface.sample(at.lever_B);
  at.n = R * sample.n;
  at.x = at.lever;
  at.x_B = at.lever_B;
  if (index < 0) {
    at.x -= radius * at.n;
    at.x_B -= radius * sample.n;
    sample.d -= radius;
  }
  at.d = sample.d;
  Vector3<S> u = motion.relative_velocity(at.x);
  if (contact.reaction == Reaction::kSurface) {
    u += at.d * Vector3<S>(motion.b.V.template head<3>()).cross(at.n);
  }
  if (how == TouchDetail::kForce) {
    at.force = contact_force<S>(law_of(contact), numbers, at.d, at.n, u);
    return;
  }
  at.gradient = R * sample.gradient;
  at.dn_dx = R * sample.dn_dx * R.transpose();
  at.dx_dlever.setIdentity();
  if (index < 0) {
    at.dx_dlever -= radius * at.dn_dx;
  }
  at.force = contact_force<S>(law_of(contact), numbers, at.d, at.n, u, at.law);
}

template <Scalar S>
PointSlopes<S> point_slopes(Reaction reaction, const PairMotion<S>& motion,
                            const TouchingPoint<S>& point) {
  PointSlopes<S> out;
  out.force = point.law.by_d * point.gradient.transpose() + point.law.by_n * point.dn_dx;
  Matrix3<S> velocity = skew<S>(motion.relative_rotation()) * point.dx_dlever;
  if (reaction == Reaction::kSurface) {
    const Matrix3<S> offset = point.n * point.gradient.transpose() + point.d * point.dn_dx;
    out.reaction = point.dx_dlever - offset;
    velocity += skew<S>(motion.b.V.template head<3>()) * offset;
  } else {
    out.reaction = point.dx_dlever;
  }
  out.force.noalias() += point.law.by_u * velocity;
  return out;
}

template <Scalar S>
void add_wrenches(Reaction reaction, const TouchingPoint<S>& point, PairWrenches<S>& wrenches) {
  const Vector6<S> on_a = wrench_at<S>(point.x, point.force.f);
  wrenches.on_a += on_a;
  wrenches.on_b -= reaction == Reaction::kPoint
                       ? on_a
                       : wrench_at<S>(reaction_point(reaction, point), point.force.f);
}

template <Scalar S>
void add_stiffness(Reaction reaction, const PairMotion<S>& motion, const TouchingPoint<S>& point,
                   PairStiffness<S>& out) {
  const PointSlopes<S> at = point_slopes(reaction, motion, point);
  const Vector3<S>& x = point.x;
  const Vector3<S>& c = point.lever;
  const Matrix3<S> F = skew<S>(point.force.f);
  const Matrix3<S> own_arm = F * point.dx_dlever;
  add_sandwich<S>(x, at.force, c, out.K_a);
  // The lever arm changes too: δx × f.
  out.K_a.template topLeftCorner<3, 3>().noalias() += own_arm * skew<S>(c);
  out.K_a.template topRightCorner<3, 3>() -= own_arm;
  add_sandwich<S>(x, point.law.by_u, x, out.C_a);
  if (reaction == Reaction::kPoint) {
    return;
  }
  const Vector3<S> x_s = reaction_point(reaction, point);
  const Matrix3<S> arm = F * at.reaction;
  add_sandwich<S>(x_s, -at.force, c, out.K_b);
  out.K_b.template topLeftCorner<3, 3>().noalias() -= arm * skew<S>(c);
  out.K_b.template topRightCorner<3, 3>() += arm;
  add_sandwich<S>(x_s, -point.law.by_u, x, out.C_b);
  const Matrix3<S> by_rotation = -(point.law.by_u * skew<S>(point.d * point.n));
  out.E_a.template topRows<3>().noalias() += skew<S>(x) * by_rotation;
  out.E_a.template bottomRows<3>() += by_rotation;
  out.E_b.template topRows<3>().noalias() -= skew<S>(x_s) * by_rotation;
  out.E_b.template bottomRows<3>() -= by_rotation;
}

template <Scalar S>
void complete(Reaction reaction, const PairMotion<S>& motion, PairStiffness<S>& stiffness) {
  const Matrix6<S> carried = carried_twist<S>(motion.a.V);
  stiffness.K_a.noalias() += stiffness.C_a * carried;
  if (reaction == Reaction::kPoint) {
    stiffness.K_b = -stiffness.K_a;
    stiffness.C_b = -stiffness.C_a;
  } else {
    stiffness.K_b.noalias() += stiffness.C_b * carried;
  }
}

template <Scalar S>
PairWrenches<S> wrench_change(Reaction reaction, const PairMotion<S>& motion,
                              const TouchingPoint<S>& point, const PointChange<S>& change) {
  const S d = point.gradient.dot(change.x) + change.d;
  const Vector3<S> n = point.dn_dx * change.x + change.n;
  const Vector3<S> x = point.dx_dlever * change.x + change.place;
  Vector3<S> u = motion.relative_rotation().cross(x);
  Vector3<S> x_s = x;
  if (reaction == Reaction::kSurface) {
    const Vector3<S> offset = d * point.n + point.d * n;
    u += Vector3<S>(motion.b.V.template head<3>()).cross(offset);
    x_s -= offset;
  }
  const Vector3<S> f = d * point.law.by_d + point.law.by_n * n + point.law.by_u * u + change.f;
  const Vector3<S>& f0 = point.force.f;
  const Vector3<S> arm = reaction_point(reaction, point);
  return {spatial<S>(x.cross(f0) + point.x.cross(f), f),
          spatial<S>(-x_s.cross(f0) - arm.cross(f), -f)};
}

#define HBAR_INSTANTIATE(S)                                                                        \
  template void compute_touch(const Contact&, const LawNumbers<S>&, const SurfaceDistance<S>&,     \
                              const PairMotion<S>&, int, const Vector3<S>&, const S&, TouchDetail, \
                              TouchingPoint<S>&);                                                  \
  template PointSlopes<S> point_slopes(Reaction, const PairMotion<S>&, const TouchingPoint<S>&);   \
  template void add_wrenches(Reaction, const TouchingPoint<S>&, PairWrenches<S>&);                 \
  template void add_stiffness(Reaction, const PairMotion<S>&, const TouchingPoint<S>&,             \
                              PairStiffness<S>&);                                                  \
  template void complete(Reaction, const PairMotion<S>&, PairStiffness<S>&);                       \
  template PairWrenches<S> wrench_change(Reaction, const PairMotion<S>&, const TouchingPoint<S>&,  \
                                         const PointChange<S>&);
HBAR_INSTANTIATE(double)
HBAR_INSTANTIATE(Dual)
#undef HBAR_INSTANTIATE

}  // namespace hbar
