#include "hbar/contact/contact_law.h"

namespace hbar {
namespace {

/// A scalar force law of d and ḋ: its value, slopes, and derivatives with respect to (k_n, μ, k_d,
/// s).
template <Scalar S>
struct ScalarLaw {
  S value = S(0.0);
  S by_d = S(0.0);
  S by_rate = S(0.0);
  S by_kn = S(0.0);
  S by_mu = S(0.0);
  S by_damping = S(0.0);
  S by_scale = S(0.0);
  bool pulls = false;  // at d = 0: as soon as there is depth
};

template <Scalar S>
ScalarLaw<S> normal_law(const LawChoice& law, const LawNumbers<S>& k, const S& d, const S& rate) {
  ScalarLaw<S> out;
  if (law.normal == NormalLaw::kLinear) {
    out = {-k.kn * d - k.damping * rate, -k.kn, -k.damping, -d, S(0.0), -rate, S(0.0)};
  } else {
    const S pressure = -k.kn * d + k.damping * rate * d;
    out = {k.scale * pressure,
           k.scale * (k.damping * rate - k.kn),
           k.scale * k.damping * d,
           -k.scale * d,
           S(0.0),
           k.scale * rate * d,
           pressure};
  }
  out.pulls = out.value < 0.0 || (out.value == 0.0 && out.by_d > 0.0);
  return out.pulls && !law.adhesion ? ScalarLaw<S>{.pulls = true} : out;
}

/// The bound on friction: μ |f_n|; of the linear law μ k_n |d|.
template <Scalar S>
ScalarLaw<S> friction_bound(const LawChoice& law, const LawNumbers<S>& k, const S& d,
                            const ScalarLaw<S>& normal) {
  if (normal.pulls && !law.adhesion) {
    return {};  // nothing presses
  }
  if (law.normal == NormalLaw::kLinear) {
    const S depth = -d;
    return {k.mu * k.kn * depth, -k.mu * k.kn, S(0.0), k.mu * depth, k.kn * depth, S(0.0), S(0.0)};
  }
  const S slope = normal.pulls ? -k.mu : k.mu;
  return {slope * normal.value,
          slope * normal.by_d,
          slope * normal.by_rate,
          slope * normal.by_kn,
          normal.value < 0.0 ? -normal.value : normal.value,
          slope * normal.by_damping,
          slope * normal.by_scale};
}

/// The part of the law that value and derivatives share.
template <Scalar S>
struct Evaluation {
  S rate;              // ḋ
  Vector3<S> sliding;  // ṫ
  ScalarLaw<S> normal;
  ScalarLaw<S> bound;
  S stick_stiffness;  // s k_t
  bool on_stick_branch;
  Vector3<S> direction;  // of sliding friction: ṫ / speed; zero on the stick branch
  S speed;               // |ṫ|, or √(|ṫ|² + width²)
  PointForce<S> force;
};

template <Scalar S>
Evaluation<S> evaluate(const LawChoice& law, const LawNumbers<S>& k, const S& d,
                       const Vector3<S>& n, const Vector3<S>& u) {
  using std::sqrt;
  Evaluation<S> out;
  out.rate = n.dot(u);
  out.sliding = u - out.rate * n;
  out.normal = normal_law<S>(law, k, d, out.rate);
  out.bound = friction_bound<S>(law, k, d, out.normal);
  out.stick_stiffness = law.normal == NormalLaw::kLinear ? k.kt : k.scale * k.kt;
  const bool smooth = law.friction == FrictionLaw::kSmooth;
  const S squared = out.sliding.squaredNorm();
  const bool within =
      out.stick_stiffness * out.stick_stiffness * squared <= out.bound.value * out.bound.value;
  out.on_stick_branch = !smooth && within;
  if (squared == 0.0 && out.bound.value == 0.0) {
    out.stick_stiffness = S(0.0);  // no force to stick with: sliding has no direction either
  }
  Vector3<S> friction;
  if (out.on_stick_branch) {
    out.speed = S(1.0);
    out.direction.setZero();
    friction = -out.stick_stiffness * out.sliding;
    // Not a norm: the root's slope is not finite at rest.
    out.force.friction = squared > 0.0 ? S(out.stick_stiffness * sqrt(squared)) : S(0.0);
    out.force.sticks = true;
  } else {
    out.speed =
        smooth ? S(sqrt(squared + law.friction_width * law.friction_width)) : S(sqrt(squared));
    out.direction = out.sliding / out.speed;
    friction = -out.bound.value * out.direction;
    out.force.friction = squared > 0.0 ? S(out.bound.value * sqrt(squared) / out.speed) : S(0.0);
    out.force.sticks = smooth && squared < law.friction_width * law.friction_width;
  }
  out.force.normal = out.normal.value;
  out.force.f = out.normal.value * n + friction;
  return out;
}

}  // namespace

LawChoice law_of(const Contact& contact) {
  return {contact.normal_law, contact.friction_law, contact.friction_width, contact.adhesion};
}

template <Scalar S>
PointForce<S> contact_force(const LawChoice& law, const LawNumbers<S>& numbers, const S& d,
                            const Vector3<S>& n, const Vector3<S>& u) {
  return evaluate<S>(law, numbers, d, n, u).force;
}

template <Scalar S>
PointForce<S> contact_force(const LawChoice& law, const LawNumbers<S>& numbers, const S& d,
                            const Vector3<S>& n, const Vector3<S>& u,
                            PointForceDerivatives<S>& out) {
  const Evaluation<S> at = evaluate<S>(law, numbers, d, n, u);
  const Vector3<S>& e = at.direction;
  // −∂friction/∂ṫ.
  Matrix3<S> resistance;
  if (at.on_stick_branch) {
    resistance = at.stick_stiffness * Matrix3<S>::Identity();
  } else {
    resistance = (at.bound.value / at.speed) * (Matrix3<S>::Identity() - e * e.transpose());
  }
  out.by_d = at.normal.by_d * n - at.bound.by_d * e;
  const Vector3<S> by_rate = at.normal.by_rate * n - at.bound.by_rate * e;
  // δḋ = n·δu + u·δn,  δṫ = (1 − n nᵀ) δu − (n uᵀ + ḋ) δn.
  out.by_u = by_rate * n.transpose() - resistance + (resistance * n) * n.transpose();
  out.by_n = by_rate * u.transpose() + (resistance * n) * u.transpose() + at.rate * resistance +
             at.normal.value * Matrix3<S>::Identity();
  const bool linear = law.normal == NormalLaw::kLinear;
  out.by_scale = at.normal.by_scale * n - at.bound.by_scale * e;
  out.by_coefficient[0] = at.normal.by_kn * n - at.bound.by_kn * e;
  out.by_coefficient[1].setZero();
  out.by_coefficient[2] = -at.bound.by_mu * e;
  out.by_coefficient[3] = at.normal.by_damping * n - at.bound.by_damping * e;
  if (at.on_stick_branch) {
    out.by_coefficient[1] = -(linear ? S(1.0) : numbers.scale) * at.sliding;
    if (!linear) {
      out.by_scale -= numbers.kt * at.sliding;
    }
  }
  return at.force;
}

#define HBAR_INSTANTIATE(S)                                                              \
  template PointForce<S> contact_force(const LawChoice&, const LawNumbers<S>&, const S&, \
                                       const Vector3<S>&, const Vector3<S>&);            \
  template PointForce<S> contact_force(const LawChoice&, const LawNumbers<S>&, const S&, \
                                       const Vector3<S>&, const Vector3<S>&,             \
                                       PointForceDerivatives<S>&);
HBAR_INSTANTIATE(double)
HBAR_INSTANTIATE(Dual)
#undef HBAR_INSTANTIATE

}  // namespace hbar
