#pragma once

#include <array>

#include "hbar/core/model/contact.h"

namespace hbar {

/// The numbers of a contact law with parameters applied.
template <Scalar S>
struct LawNumbers {
  S kn = S(0.0);  ///< see ContactCoefficients
  S kt = S(0.0);
  S mu = S(0.0);
  S damping = S(0.0);
  S scale = S(1.0);  ///< s of (13), (14)
};

/// Which law: the choices of a Contact.
struct LawChoice {
  NormalLaw normal = NormalLaw::kDocument;
  FrictionLaw friction = FrictionLaw::kDocument;
  double friction_width = 0.0;
  bool adhesion = true;
};
[[nodiscard]] LawChoice law_of(const Contact& contact);

/// The force on a contact point, and its components.
template <Scalar S>
struct PointForce {
  Vector3<S> f;  ///< f_n n + friction, world                                  [3]
  S normal;      ///< f_n; negative where damping pulls
  S friction;    ///< |friction|
  bool sticks;   ///< friction below its bound (smooth law: |ṫ| below its width)
};

/// Partial derivatives of f with respect to distance d, normal n and relative velocity u.
template <Scalar S>
struct PointForceDerivatives {
  Vector3<S> by_d;      ///< ∂f/∂d                                   [3]
  Matrix3<S> by_n;      ///< ∂f/∂n                                   [3 x 3]
  Matrix3<S> by_u;      ///< ∂f/∂u                                   [3 x 3]
  Vector3<S> by_scale;  ///< ∂f/∂s                                   [3]
  std::array<Vector3<S>, 4> by_coefficient;  ///< ∂f/∂(k_n, k_t, μ, k_d)              4 of [3]
};

/// Force of (13), (14) on a point at distance d ≤ 0.
///
/// @param n  contact normal, unit, out of the other body                         [3]
/// @param u  velocity of the point relative to the other body; ḋ = n·u, ṫ = u − ḋ n  [3]
template <Scalar S>
[[nodiscard]] PointForce<S> contact_force(const LawChoice& law, const LawNumbers<S>& numbers,
                                          const S& d, const Vector3<S>& n, const Vector3<S>& u);

/// The same with derivatives. Where sticking turns into sliding they are those of sticking; they
/// are finite at rest (ṫ = 0) and at d = 0.
template <Scalar S>
PointForce<S> contact_force(const LawChoice& law, const LawNumbers<S>& numbers, const S& d,
                            const Vector3<S>& n, const Vector3<S>& u,
                            PointForceDerivatives<S>& derivatives);

}  // namespace hbar
