#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "hbar/core/base/scalar.h"

namespace hbar {

/// A box. This and the other solid shapes are given in the body frame, centred at the centre of
/// mass; lengths are in the scene's units.
struct Cuboid {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< side lengths along x, y, z  [3]
  friend bool operator==(const Cuboid& a, const Cuboid& b) { return a.size == b.size; }
};
/// A ball.
struct Sphere {
  double radius = 1.0;  ///< length
  friend bool operator==(const Sphere&, const Sphere&) = default;
};
/// A right circular cylinder about z.
struct Cylinder {
  double radius = 1.0;  ///< length
  double length = 1.0;  ///< end face to end face, length
  friend bool operator==(const Cylinder&, const Cylinder&) = default;
};
/// A cylinder about z closed by two half-balls.
struct Capsule {
  double radius = 1.0;  ///< length
  double length = 1.0;  ///< between the centres of the half-balls, length
  friend bool operator==(const Capsule&, const Capsule&) = default;
};
/// A body known by its mass properties alone (mesh and abstract bodies).
struct NoShape {
  friend bool operator==(const NoShape&, const NoShape&) = default;
};
using Shape = std::variant<NoShape, Cuboid, Sphere, Cylinder, Capsule>;

/// The number of lengths that define a shape: 3 of a cuboid, 1 of a ball, 2 of a cylinder or a
/// capsule, 0 of NoShape.
[[nodiscard]] int size_count(const Shape& shape);

/// Those lengths: a cuboid's x, y, z; a ball's radius; a cylinder's or a capsule's radius, length.
[[nodiscard]] std::vector<double> sizes_of(const Shape& shape);

/// Their names, in the same order: "size.x", "size.y", "size.z"; "radius"; "radius", "length".
[[nodiscard]] std::vector<std::string> size_names(const Shape& shape);

/// A shape of the same kind with other lengths, which are not checked.
///
/// @param sizes  as sizes_of(shape) orders them, length  [size_count(shape)]
/// @throws InvalidInput if their number is not size_count(shape)
[[nodiscard]] Shape with_sizes(const Shape& shape, std::span<const double> sizes);

/// Mass and principal moments of a solid about its centre of mass.
struct MassProperties {
  double mass = 0.0;                                  ///< mass
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();  ///< principal moments, mass·length² [3]
};

/// The same for a solid of density 1.
template <Scalar S>
struct UnitSolid {
  S mass;              ///< length³
  Vector3<S> moments;  ///< length⁵                                                  [3]
};

/// @param kind   which shape; its own lengths are not read
/// @param sizes  lengths as sizes_of orders them, the rest unread                    [3]
/// @throws InvalidInput for NoShape
template <Scalar S>
[[nodiscard]] UnitSolid<S> unit_solid(const Shape& kind, const Vector3<S>& sizes);

/// Their derivative with respect to one of the sizes, ∂(mass, moments)/∂size_k.
///
/// @param k  which size, below size_count(kind)
/// @throws InvalidInput for NoShape
template <Scalar S>
[[nodiscard]] UnitSolid<S> unit_solid_rate(const Shape& kind, const Vector3<S>& sizes, int k);

/// Mass properties of a homogeneous solid.
///
/// @param shape    any shape but NoShape; lengths > 0
/// @param density  mass per volume, > 0
/// @throws InvalidInput if a length or the density is not positive, or the shape is NoShape
[[nodiscard]] MassProperties solid_mass_properties(const Shape& shape, double density);

}  // namespace hbar
