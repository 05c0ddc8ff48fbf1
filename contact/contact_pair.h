#pragma once

#include "hbar/contact/contact_law.h"
#include "hbar/contact/surface_distance.h"
#include "hbar/core/dynamics/body_motion.h"

namespace hbar {

/// Room for touching points that is reserved from the start; rarely do more touch at once.
inline constexpr std::size_t kReservedTouches = 1024;

template <Scalar S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

/// The two bodies of a contact at one instant, A with the points and B with the distance.
template <Scalar S>
struct PairMotion {
  BodyMotion<S> a;
  BodyMotion<S> b;

  /// Velocity of A's material at x relative to B's.                                       [3]
  [[nodiscard]] Vector3<S> relative_velocity(const Vector3<S>& x) const {
    const Vector6<S> V = a.V - b.V;
    return V.template tail<3>() + Vector3<S>(V.template head<3>()).cross(x);
  }
  [[nodiscard]] Vector3<S> relative_rotation() const { return (a.V - b.V).template head<3>(); }
};

/// Wrenches on both bodies in the world frame, about its origin. on_b = −on_a unless B reacts at
/// its surface.
template <Scalar S>
struct PairWrenches {
  Vector6<S> on_a = Vector6<S>::Zero();  ///< [6]
  Vector6<S> on_b = Vector6<S>::Zero();  ///< [6]
};

/// A contact point that touches, with the law's derivatives there.
template <Scalar S>
struct TouchingPoint {
  int index = 0;         ///< among the body's contact points; −1: a ball's deepest point
  Vector3<S> x;          ///< where the force acts on A, world                [3]
  Vector3<S> lever;      ///< point of A that x moves with: x or a ball's centre  [3]
  Vector3<S> lever_B;    ///< the lever in B's frame: where the distance is taken [3]
  Vector3<S> x_B;        ///< x in B's frame                                  [3]
  S d;                   ///< signed distance
  Vector3<S> gradient;   ///< ∂d/∂x                                           [3]
  Vector3<S> n;          ///< normal                                          [3]
  Matrix3<S> dn_dx;      ///< ∂n/∂x                                           [3 x 3]
  Matrix3<S> dx_dlever;  ///< 1, or 1 − radius ∂n/∂x of a ball                [3 x 3]
  PointForce<S> force;
  PointForceDerivatives<S> law;
};

/// A change of one point: of its place on A (a ball's centre), of where the force acts, of distance
/// and normal at a fixed place, and of the force with everything else fixed.
template <Scalar S>
struct PointChange {
  Vector3<S> x = Vector3<S>::Zero();
  Vector3<S> place = Vector3<S>::Zero();
  S d = S(0.0);
  Vector3<S> n = Vector3<S>::Zero();
  Vector3<S> f = Vector3<S>::Zero();
};

/// How a pair's wrenches respond to motion. For a displacement twist D of one side (σ = 1: A alone,
/// −1: B alone, 0: both or none) and the change of twist Ψ̇ that comes with it (doc/notation.md,
/// "Columns"), the change that remains after carrying the wrenches along with their bodies is
///
///     δ°w_a = σ (K_a D + C_a Ψ̇ − D ×* w_a) + [B moves] E_a ω(Ψ̇)
///     δ°w_b = σ (K_b D + C_b Ψ̇)            + [B moves] E_b ω(Ψ̇)
///
/// E is zero unless B reacts at its surface, whose velocity there does not depend on relative
/// motion alone.
template <Scalar S>
struct PairStiffness {
  Matrix6<S> K_a, C_a, K_b, C_b;
  Eigen::Matrix<S, 6, 3> E_a, E_b;
};

/// What to compute for a touching point: the force alone, or its derivatives too.
enum class TouchDetail { kForce, kDerivatives };

/// The force of a touching point.
///
/// @param index, x_A  the point and its place in A's frame; index −1: a ball's centre, whose
///                    deepest point (radius below it) touches
/// @param how         whether to fill in gradient, dn_dx and the law's derivatives too
template <Scalar S>
void compute_touch(const Contact& contact, const LawNumbers<S>& numbers,
                   const SurfaceDistance<S>& surface, const PairMotion<S>& motion, int index,
                   const Vector3<S>& x_A, const S& radius, TouchDetail how, TouchingPoint<S>& out);

/// Derivatives with respect to a displacement of the lever relative to B, at a fixed relative twist
/// in B's frame: of the force f, and of the point x_s at which B reacts.
template <Scalar S>
struct PointSlopes {
  Matrix3<S> force;     ///< ∂f/∂lever                                                  [3 x 3]
  Matrix3<S> reaction;  ///< ∂x_s/∂lever                                                [3 x 3]
};
template <Scalar S>
[[nodiscard]] PointSlopes<S> point_slopes(Reaction reaction, const PairMotion<S>& motion,
                                          const TouchingPoint<S>& point);

/// Adds a point's wrenches.
template <Scalar S>
void add_wrenches(Reaction reaction, const TouchingPoint<S>& point, PairWrenches<S>& wrenches);

/// Adds a point to the stiffness, as derivatives with respect to relative motion: K at fixed
/// relative velocity in B's frame; complete() turns the sum into K_a, K_b of the struct's formula.
template <Scalar S>
void add_stiffness(Reaction reaction, const PairMotion<S>& motion, const TouchingPoint<S>& point,
                   PairStiffness<S>& stiffness);
template <Scalar S>
void complete(Reaction reaction, const PairMotion<S>& motion, PairStiffness<S>& stiffness);

/// The change of both wrenches caused by a change of a point.
template <Scalar S>
[[nodiscard]] PairWrenches<S> wrench_change(Reaction reaction, const PairMotion<S>& motion,
                                            const TouchingPoint<S>& point,
                                            const PointChange<S>& change);

}  // namespace hbar
