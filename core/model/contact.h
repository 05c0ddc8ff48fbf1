#pragma once

#include <memory>
#include <string>
#include <variant>

#include "hbar/core/geometry/distance_field.h"

namespace hbar {

/// Numbers of a contact law, per contact point.
struct ContactCoefficients {
  double kn = 0.0;       ///< normal stiffness, force/length, ≥ 0
  double kt = 0.0;       ///< tangential force per sliding velocity while sticking, ≥ 0
  double mu = 0.0;       ///< coefficient of friction, ≥ 0
  double damping = 0.0;  ///< k_d, force·time/length² (linear law: force·time/length), ≥ 0
  friend bool operator==(const ContactCoefficients&, const ContactCoefficients&) = default;
};

/// Normal force f_n at signed distance d < 0 with rate ḋ.
enum class NormalLaw {
  kDocument,  ///< s (−k_n d + k_d ḋ d)  (13)
  kLinear     ///< −k_n d − k_d ḋ: jumps at touchdown if damped
};

/// Friction at sliding velocity ṫ.
enum class FrictionLaw {
  kDocument,  ///< min(s k_t |ṫ|, μ |f_n|) against ṫ  (14)
  kSmooth  ///< μ |f_n| |ṫ| / √(|ṫ|² + width²) against ṫ: smooth in ṫ; k_t is not used
};

/// Where a point's force acts on the other body.
enum class Reaction {
  kPoint,   ///< at the contact point: angular momentum is conserved
  kSurface  ///< at its own surface point x − d n, whose velocity counts too
};

/// The other body's own shape (Body::shape), with its current sizes.
struct OwnShape {
  bool caps = true;  ///< a cylinder's end faces count for its distance
  friend bool operator==(const OwnShape&, const OwnShape&) = default;
};
/// A half-space fixed in the other body's frame, or in the world's if there is no other body.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< on the plane, length      [3]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< out of the solid, unit    [3]
  friend bool operator==(const Plane& a, const Plane& b) {
    return a.point == b.point && a.normal == b.normal;
  }
};
/// What contact points are tested against.
using ContactSurface = std::variant<OwnShape, Plane, std::shared_ptr<const DistanceField>>;

/// Whether two surfaces are the same: distance fields by what they hold, so that those of one mesh
/// that was loaded twice are.
[[nodiscard]] inline bool same_surface(const ContactSurface& a, const ContactSurface& b) {
  using Field = std::shared_ptr<const DistanceField>;
  const auto* field = std::get_if<Field>(&a);
  const auto* other = std::get_if<Field>(&b);
  if (field == nullptr || other == nullptr || *field == nullptr || *other == nullptr) {
    return a == b;
  }
  return (*field)->same_as(**other);
}

/// A declared contact: the points of one body against the signed distance of another, or of the
/// world. A ball touches a plane with its deepest point, and likewise a body's own shape if the
/// ball has no contact points; all other bodies touch with Body::contact_points.
struct Contact {
  std::string name = {};  ///< empty: "POINTS_BODY-OTHER_BODY"
  int link = 0;           ///< A: whose points
  int other = -1;         ///< B: whose distance; −1 is the world
  ContactSurface surface = OwnShape{};
  ContactCoefficients coefficients = {};
  NormalLaw normal_law = NormalLaw::kDocument;
  FrictionLaw friction_law = FrictionLaw::kDocument;
  double friction_width = 0.0;  ///< of the smooth law, length/time, > 0 for it
  bool adhesion = true;  ///< f_n may pull when damping outweighs stiffness; else it is cut off at 0
  Reaction reaction = Reaction::kPoint;

  friend bool operator==(const Contact& a, const Contact& b) {
    return a.name == b.name && a.link == b.link && a.other == b.other &&
           same_surface(a.surface, b.surface) && a.coefficients == b.coefficients &&
           a.normal_law == b.normal_law && a.friction_law == b.friction_law &&
           a.friction_width == b.friction_width && a.adhesion == b.adhesion &&
           a.reaction == b.reaction;
  }
};

/// Points on a body that measure the contact force there and exert none.
struct TactileSensor {
  std::string name = {};
  int link = 0;                  ///< whose body carries the points
  Eigen::Matrix3Xd points = {};  ///< in the body frame, length                  [3 x points]
  Eigen::Matrix3Xd axis0 = {};   ///< first shear direction of each, unit        [3 x points]
  Eigen::Matrix3Xd axis1 = {};   ///< second shear direction of each, unit       [3 x points]
  ContactCoefficients coefficients = {};

  friend bool operator==(const TactileSensor& a, const TactileSensor& b) {
    const auto same = [](const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& y) {
      return x.cols() == y.cols() && x == y;  // Eigen compares matrices of one size only
    };
    return a.name == b.name && a.link == b.link && same(a.points, b.points) &&
           same(a.axis0, b.axis0) && same(a.axis1, b.axis1) && a.coefficients == b.coefficients;
  }
};

}  // namespace hbar
