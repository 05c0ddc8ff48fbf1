#include "hbar/core/geometry/shape.h"

#include <array>
#include <numbers>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

void require_positive(double value, std::string_view what) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw InvalidInput(
        concat("solid_mass_properties: ", what, " is ", value, "; it must be positive and finite"));
  }
}

template <Scalar S>
UnitSolid<S> unit(const Cuboid&, const Vector3<S>& size) {
  const Vector3<S> squared = size.cwiseAbs2();
  const S mass = size[0] * size[1] * size[2];
  return {mass, mass / 12.0 * (Vector3<S>::Constant(squared.sum()) - squared)};
}

template <Scalar S>
UnitSolid<S> unit(const Sphere&, const Vector3<S>& size) {
  const S& r = size[0];
  const S mass = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return {mass, Vector3<S>::Constant(0.4 * mass * r * r)};
}

template <Scalar S>
UnitSolid<S> unit(const Cylinder&, const Vector3<S>& size) {
  const S r2 = size[0] * size[0];
  const S& length = size[1];
  const S mass = std::numbers::pi * r2 * length;
  const S across = mass * (3.0 * r2 + length * length) / 12.0;
  return {mass, {across, across, 0.5 * mass * r2}};
}

template <Scalar S>
UnitSolid<S> unit(const Capsule&, const Vector3<S>& size) {
  const S& r = size[0];
  const S& length = size[1];
  const UnitSolid<S> tube = unit<S>(Cylinder{}, size);
  const UnitSolid<S> ball = unit<S>(Sphere{}, size);
  // A half-ball's centre of mass lies 3r/8 beyond its flat face. About its own centre of mass its
  // transverse moment is (2/5 − 9/64) m r²; both halves are then moved out to length/2 + 3r/8.
  const S out = 0.5 * length + 0.375 * r;
  const S across = tube.moments.x() + ball.mass * ((0.4 - 9.0 / 64.0) * r * r + out * out);
  return {tube.mass + ball.mass, {across, across, tube.moments.z() + ball.moments.z()}};
}

template <Scalar S>
UnitSolid<S> unit(const NoShape&, const Vector3<S>&) {
  throw InvalidInput("solid_mass_properties: a body without a shape has no volume; give its mass");
}

template <Scalar S>
UnitSolid<S> size_rate(const Cuboid&, const Vector3<S>& size, int k) {
  const UnitSolid<S> solid = unit<S>(Cuboid{}, size);
  UnitSolid<S> out{solid.mass / size[k], solid.moments / size[k]};
  for (int i = 0; i < 3; ++i) {
    out.moments[i] += i == k ? S(0.0) : S(solid.mass * size[k] / 6.0);
  }
  return out;
}

template <Scalar S>
UnitSolid<S> size_rate(const Sphere&, const Vector3<S>& size, int) {
  const UnitSolid<S> solid = unit<S>(Sphere{}, size);
  return {3.0 * solid.mass / size[0], (5.0 / size[0]) * solid.moments};
}

template <Scalar S>
UnitSolid<S> size_rate(const Cylinder&, const Vector3<S>& size, int k) {
  const UnitSolid<S> solid = unit<S>(Cylinder{}, size);
  const S& across = solid.moments[0];
  const S& along = solid.moments[2];
  const S half = 0.5 * solid.mass * size[0];
  if (k == 0) {
    const S by_r = 2.0 * across / size[0] + half;
    return {2.0 * solid.mass / size[0], {by_r, by_r, 4.0 * along / size[0]}};
  }
  const S by_length = across / size[1] + solid.mass * size[1] / 6.0;
  return {solid.mass / size[1], {by_length, by_length, along / size[1]}};
}

template <Scalar S>
UnitSolid<S> size_rate(const Capsule&, const Vector3<S>& size, int k) {
  const S& r = size[0];
  const UnitSolid<S> tube = size_rate<S>(Cylinder{}, size, k);
  const UnitSolid<S> ball = unit<S>(Sphere{}, size);
  const S out = 0.5 * size[1] + 0.375 * r;
  if (k == 1) {
    const S across = tube.moments.x() + ball.mass * out;
    return {tube.mass, {across, across, tube.moments.z()}};
  }
  const UnitSolid<S> ball_rate = size_rate<S>(Sphere{}, size, 0);
  const S across = tube.moments.x() + ball_rate.mass * ((0.4 - 9.0 / 64.0) * r * r + out * out) +
                   ball.mass * (2.0 * (0.4 - 9.0 / 64.0) * r + 0.75 * out);
  return {tube.mass + ball_rate.mass, {across, across, tube.moments.z() + ball_rate.moments.z()}};
}

template <Scalar S>
UnitSolid<S> size_rate(const NoShape&, const Vector3<S>& size, int) {
  return unit<S>(NoShape{}, size);  // says that there is none
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

int size_count(const Shape& shape) {
  constexpr std::array<int, 5> kCounts = {0, 3, 1, 2, 2};
  return kCounts[shape.index()];
}

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

template <Scalar S>
UnitSolid<S> unit_solid(const Shape& kind, const Vector3<S>& sizes) {
  return std::visit([&sizes](const auto& solid) { return unit<S>(solid, sizes); }, kind);
}

template <Scalar S>
UnitSolid<S> unit_solid_rate(const Shape& kind, const Vector3<S>& sizes, int k) {
  return std::visit([&sizes, k](const auto& solid) { return size_rate<S>(solid, sizes, k); }, kind);
}

template UnitSolid<double> unit_solid_rate(const Shape&, const Vector3<double>&, int);
template UnitSolid<Dual> unit_solid_rate(const Shape&, const Vector3<Dual>&, int);
template UnitSolid<double> unit_solid(const Shape&, const Vector3<double>&);
template UnitSolid<Dual> unit_solid(const Shape&, const Vector3<Dual>&);

MassProperties solid_mass_properties(const Shape& shape, double density) {
  require_positive(density, "the density");
  const std::vector<double> sizes = sizes_of(shape);
  const std::vector<std::string> names = size_names(shape);
  Eigen::Vector3d padded = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    require_positive(sizes[k], names[k]);
    padded[static_cast<Eigen::Index>(k)] = sizes[k];
  }
  const UnitSolid<double> solid = unit_solid<double>(shape, padded);
  return {density * solid.mass, density * solid.moments};
}

}  // namespace hbar
