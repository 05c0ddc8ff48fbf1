#include "hbar/core/geometry/surface_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Points = std::vector<Eigen::Vector3d>;

void require_at_least(int least, int found, const char* what) {
  if (found < least) {
    throw InvalidInput(
        concat("surface_points: ", what, " is ", found, "; it must be at least ", least));
  }
}

/// The point at angle 2π k / count of a circle about z.
Eigen::Vector3d on_circle(double radius, double z, int k, int count) {
  const double angle = 2.0 * std::numbers::pi * k / count;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Point i of `count` on the line from −length/2 to length/2.
double along(double length, int i, int count) {
  return (static_cast<double>(i) / (count - 1) - 0.5) * length;
}

double count_of(const NoShape&, const SurfaceResolution&) { return 0.0; }
double count_of(const Cuboid&, const SurfaceResolution& resolution) {
  const auto [nx, ny, nz] = resolution.cuboid;
  const double all = static_cast<double>(nx) * ny * nz;
  return all - std::max(nx - 2.0, 0.0) * std::max(ny - 2.0, 0.0) * std::max(nz - 2.0, 0.0);
}
double count_of(const Sphere&, const SurfaceResolution& resolution) {
  const auto [rings, around] = resolution.sphere;
  return rings == 0 && around == 0 ? 0.0 : 2.0 + static_cast<double>(rings) * around;
}
double count_of(const Cylinder&, const SurfaceResolution& resolution) {
  const auto [angles, radii] = resolution.cylinder;
  return 2.0 + 2.0 * static_cast<double>(angles) * radii;
}
double count_of(const Capsule&, const SurfaceResolution& resolution) {
  const auto [rings, around] = resolution.capsule;
  return 2.0 + static_cast<double>(rings) * around;
}

Points sample(const NoShape&, const SurfaceResolution&) { return {}; }

Points sample(const Cuboid& cuboid, const SurfaceResolution& resolution) {
  const auto [nx, ny, nz] = resolution.cuboid;
  for (const int n : {nx, ny, nz}) {
    require_at_least(2, n, "a cuboid's number of points along a side");
  }
  const auto is_end = [](int i, int count) { return i == 0 || i == count - 1; };
  Points points;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const bool inside = !is_end(i, nx) && !is_end(j, ny);
      for (int k = 0; k < nz; k += inside ? nz - 1 : 1) {
        points.emplace_back(along(cuboid.size.x(), i, nx), along(cuboid.size.y(), j, ny),
                            along(cuboid.size.z(), k, nz));
      }
    }
  }
  return points;
}

Points sample(const Sphere& sphere, const SurfaceResolution& resolution) {
  const auto [rings, around] = resolution.sphere;
  if (rings == 0 && around == 0) {
    return {};
  }
  require_at_least(1, rings, "a sphere's number of rings");
  require_at_least(1, around, "a sphere's number of points of each ring");
  const double r = sphere.radius;
  Points points = {{0.0, 0.0, r}, {0.0, 0.0, -r}};
  for (int i = 1; i <= rings; ++i) {  // from −z up, as a capsule's
    const double polar = std::numbers::pi * i / (rings + 1);
    for (int j = 0; j < around; ++j) {
      points.push_back(on_circle(r * std::sin(polar), -r * std::cos(polar), j, around));
    }
  }
  return points;
}

Points sample(const Cylinder& cylinder, const SurfaceResolution& resolution) {
  const auto [angles, radii] = resolution.cylinder;
  require_at_least(1, angles, "a cylinder's number of angles");
  require_at_least(1, radii, "a cylinder's number of radii");
  Points points;
  for (const double z : {-0.5 * cylinder.length, 0.5 * cylinder.length}) {
    points.emplace_back(0.0, 0.0, z);
    for (int k = 0; k < angles; ++k) {
      for (int i = 1; i <= radii; ++i) {
        points.push_back(on_circle(cylinder.radius * i / radii, z, k, angles));
      }
    }
  }
  return points;
}

Points sample(const Capsule& capsule, const SurfaceResolution& resolution) {
  const auto [rings, around] = resolution.capsule;
  require_at_least(2, rings, "a capsule's number of rings");
  require_at_least(1, around, "a capsule's number of points of each ring");
  const double pole = 0.5 * capsule.length + capsule.radius;
  Points points = {{0.0, 0.0, pole}, {0.0, 0.0, -pole}};
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      points.push_back(on_circle(capsule.radius, along(capsule.length, i, rings), j, around));
    }
  }
  return points;
}

Eigen::Vector3d rate(const NoShape&, const Eigen::Vector3d&, int) {
  return Eigen::Vector3d::Zero();
}
Eigen::Vector3d rate(const Cuboid& cuboid, const Eigen::Vector3d& C, int k) {
  return C[k] / cuboid.size[k] * Eigen::Vector3d::Unit(k);
}
Eigen::Vector3d rate(const Sphere& sphere, const Eigen::Vector3d& C, int) {
  return C / sphere.radius;
}
Eigen::Vector3d rate(const Cylinder& cylinder, const Eigen::Vector3d& C, int k) {
  if (k == 0) {
    return Eigen::Vector3d(C.x(), C.y(), 0.0) / cylinder.radius;
  }
  return C.z() / cylinder.length * Eigen::Vector3d::UnitZ();
}
Eigen::Vector3d rate(const Capsule& capsule, const Eigen::Vector3d& C, int k) {
  // Between the half-balls a capsule is a cylinder; in them, points keep their share of the radius.
  const double half = 0.5 * capsule.length;
  if (k == 1) {
    return std::clamp(C.z() / capsule.length, -0.5, 0.5) * Eigen::Vector3d::UnitZ();
  }
  return Eigen::Vector3d(C.x(), C.y(), C.z() - std::clamp(C.z(), -half, half)) / capsule.radius;
}

}  // namespace

double surface_point_count(const Shape& shape, const SurfaceResolution& resolution) {
  return std::visit([&](const auto& solid) { return count_of(solid, resolution); }, shape);
}

Eigen::Matrix3Xd surface_points(const Shape& shape, const SurfaceResolution& resolution) {
  const double count = surface_point_count(shape, resolution);
  if (count > kMaxContactPoints) {
    throw InvalidInput(concat("surface_points: the resolution gives ", count,
                              " points; a body has at most ", kMaxContactPoints));
  }
  const Points points =
      std::visit([&](const auto& solid) { return sample(solid, resolution); }, shape);
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  return columns;
}

Eigen::Vector3d surface_point_rate(const Shape& shape, const Eigen::Vector3d& C, int k) {
  const int count = size_count(shape);
  if (k < 0 || k >= count) {
    throw InvalidInput(
        concat("surface_point_rate: there is no size ", k, "; this shape has ", count));
  }
  return std::visit([&](const auto& solid) { return rate(solid, C, k); }, shape);
}

}  // namespace hbar
