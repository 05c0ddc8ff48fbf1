#include "hbar/core/shape.h"

#include <numbers>

#include "hbar/core/error.h"

namespace hbar {
namespace {

void require_positive(double value, const char* what) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw InvalidInput(
        concat("solid_mass_properties: ", what, " is ", value, "; it must be positive and finite"));
  }
}

MassProperties properties(const NoShape&, double) {
  throw InvalidInput("solid_mass_properties: a body without a shape has no volume; give its mass");
}

MassProperties properties(const Cuboid& cuboid, double density) {
  for (int i = 0; i < 3; ++i) {
    require_positive(cuboid.size[i], "a side of the cuboid");
  }
  const Eigen::Vector3d squared = cuboid.size.cwiseAbs2();
  const double mass = density * cuboid.size.prod();
  return {mass, mass / 12.0 * (Eigen::Vector3d::Constant(squared.sum()) - squared)};
}

MassProperties properties(const Sphere& sphere, double density) {
  require_positive(sphere.radius, "the radius of the sphere");
  const double r = sphere.radius;
  const double mass = density * 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return {mass, Eigen::Vector3d::Constant(0.4 * mass * r * r)};
}

MassProperties properties(const Cylinder& cylinder, double density) {
  require_positive(cylinder.radius, "the radius of the cylinder");
  require_positive(cylinder.length, "the length of the cylinder");
  const double r2 = cylinder.radius * cylinder.radius;
  const double mass = density * std::numbers::pi * r2 * cylinder.length;
  const double across = mass * (3.0 * r2 + cylinder.length * cylinder.length) / 12.0;
  return {mass, {across, across, 0.5 * mass * r2}};
}

MassProperties properties(const Capsule& capsule, double density) {
  require_positive(capsule.radius, "the radius of the capsule");
  require_positive(capsule.length, "the length of the capsule");
  const double r = capsule.radius;
  const double l = capsule.length;
  const MassProperties tube = properties(Cylinder{r, l}, density);
  const MassProperties ball = properties(Sphere{r}, density);
  // A half-ball's centre of mass lies 3r/8 beyond its flat face. About its own centre of mass its
  // transverse moment is (2/5 − 9/64) m r²; both halves are then moved out to l/2 + 3r/8.
  const double out = 0.5 * l + 0.375 * r;
  const double across = tube.inertia.x() + ball.mass * ((0.4 - 9.0 / 64.0) * r * r + out * out);
  return {tube.mass + ball.mass, {across, across, tube.inertia.z() + ball.inertia.z()}};
}

std::vector<double> sizes(const NoShape&) { return {}; }
std::vector<double> sizes(const Cuboid& cuboid) {
  return {cuboid.size.x(), cuboid.size.y(), cuboid.size.z()};
}
std::vector<double> sizes(const Sphere& sphere) { return {sphere.radius}; }
std::vector<double> sizes(const Cylinder& cylinder) { return {cylinder.radius, cylinder.length}; }
std::vector<double> sizes(const Capsule& capsule) { return {capsule.radius, capsule.length}; }

Shape resized(const NoShape&, std::span<const double>) { return NoShape{}; }
Shape resized(const Cuboid&, std::span<const double> sizes) {
  return Cuboid{{sizes[0], sizes[1], sizes[2]}};
}
Shape resized(const Sphere&, std::span<const double> sizes) { return Sphere{sizes[0]}; }
Shape resized(const Cylinder&, std::span<const double> sizes) {
  return Cylinder{sizes[0], sizes[1]};
}
Shape resized(const Capsule&, std::span<const double> sizes) { return Capsule{sizes[0], sizes[1]}; }

}  // namespace

int size_count(const Shape& shape) { return static_cast<int>(sizes_of(shape).size()); }

std::vector<double> sizes_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return sizes(solid); }, shape);
}

std::vector<std::string> size_names(const Shape& shape) {
  switch (size_count(shape)) {
    case 3:
      return {"size.x", "size.y", "size.z"};
    case 2:
      return {"radius", "length"};
    case 1:
      return {"radius"};
    default:
      return {};
  }
}

Shape with_sizes(const Shape& shape, std::span<const double> sizes) {
  const int count = size_count(shape);
  if (static_cast<int>(sizes.size()) != count) {
    throw InvalidInput(
        concat("with_sizes: got ", sizes.size(), " lengths; this shape has ", count));
  }
  return std::visit([sizes](const auto& solid) { return resized(solid, sizes); }, shape);
}

MassProperties solid_mass_properties(const Shape& shape, double density) {
  require_positive(density, "the density");
  return std::visit([density](const auto& solid) { return properties(solid, density); }, shape);
}

}  // namespace hbar
