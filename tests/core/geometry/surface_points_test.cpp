#include "hbar/core/geometry/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

using testing::message_of;

/// A shape, how it is sampled, and how many points another program found on it.
struct Sampling {
  std::string name;
  Shape shape;
  SurfaceResolution resolution;
  int count;
};

std::vector<Sampling> every_sampling() {
  return {
      {"no shape", NoShape{}, {}, 0},
      {"cuboid", Cuboid{{0.3, 0.25, 0.2}}, {}, 152},
      {"coarse cuboid", Cuboid{{0.2, 0.1, 0.1}}, {.cuboid = {5, 5, 3}}, 66},
      {"corners", Cuboid{{0.2, 0.2, 0.2}}, {.cuboid = {2, 2, 2}}, 8},
      {"pad", Cuboid{{0.1, 0.1, 0.02}}, {.cuboid = {6, 6, 2}}, 72},
      {"sphere", Sphere{0.125}, {}, 0},
      {"cylinder", Cylinder{0.125, 0.5}, {}, 50},
      {"coarse cylinder", Cylinder{0.0625, 0.25}, {.cylinder = {6, 2}}, 26},
      {"capsule", Capsule{0.125, 0.25}, {}, 22},
      {"fine capsule", Capsule{0.0625, 0.25}, {.capsule = {4, 6}}, 26},
      {"sampled sphere", Sphere{0.7}, {.sphere = {3, 5}}, 17},
  };
}

/// Distance of a point from the surface of a solid.
double from_surface(const Shape& shape, const Eigen::Vector3d& C) {
  if (const auto* cuboid = std::get_if<Cuboid>(&shape)) {
    return (C.cwiseAbs() - 0.5 * cuboid->size).maxCoeff();
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return C.norm() - sphere->radius;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return std::max(C.head<2>().norm() - cylinder->radius,
                    std::abs(C.z()) - 0.5 * cylinder->length);
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const double beyond = std::max(std::abs(C.z()) - 0.5 * capsule->length, 0.0);
    return std::hypot(C.head<2>().norm(), beyond) - capsule->radius;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(EverySampling, HasItsNumberOfDifferentPointsOnTheSurface) {
  for (const Sampling& sampling : every_sampling()) {
    SCOPED_TRACE(sampling.name);
    const Eigen::Matrix3Xd points = surface_points(sampling.shape, sampling.resolution);
    ASSERT_EQ(points.cols(), sampling.count);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      EXPECT_NEAR(from_surface(sampling.shape, points.col(i)), 0.0, 1e-15);
      for (Eigen::Index j = 0; j < i; ++j) {
        EXPECT_GT((points.col(i) - points.col(j)).norm(), 1e-3);
      }
    }
    if (points.cols() == 0) {
      continue;
    }
    EXPECT_LT(points.rowwise().mean().norm(), 1e-15);
  }
}

TEST(SurfacePoints, OfACuboidRunFastestAlongZ) {
  const Eigen::Matrix3Xd points = surface_points(Cuboid{{2.0, 4.0, 8.0}}, {.cuboid = {3, 3, 2}});
  ASSERT_EQ(points.cols(), 18);
  Eigen::Matrix3Xd expected(3, 18);
  int column = 0;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-2.0, 0.0, 2.0}) {
      for (const double z : {-4.0, 4.0}) {
        expected.col(column++) << x, y, z;
      }
    }
  }
  EXPECT_EQ(points, expected);
  const Eigen::Matrix3Xd hollow = surface_points(Cuboid{{2.0, 4.0, 8.0}}, {.cuboid = {3, 3, 3}});
  ASSERT_EQ(hollow.cols(), 26);
  EXPECT_EQ(hollow.col(12), Eigen::Vector3d(0.0, -0.0, -4.0));
  EXPECT_EQ(hollow.col(13), Eigen::Vector3d(0.0, 0.0, 4.0)) << "the centre is left out";
}

TEST(SurfacePoints, OfACylinderGoFaceByFaceAngleByAngle) {
  const Eigen::Matrix3Xd points = surface_points(Cylinder{2.0, 6.0}, {.cylinder = {4, 2}});
  Eigen::Matrix3Xd face(3, 9);
  face << 0, 1, 2, 0, 0, -1, -2, 0, 0,  //
      0, 0, 0, 1, 2, 0, 0, -1, -2,      //
      -3, -3, -3, -3, -3, -3, -3, -3, -3;
  Eigen::Matrix3Xd expected(3, 18);
  expected << face, Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal() * face;
  EXPECT_LT((points - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SurfacePoints, OfACapsuleArePolesThenRingsUpwards) {
  const Eigen::Matrix3Xd points = surface_points(Capsule{1.0, 4.0}, {.capsule = {3, 2}});
  Eigen::Matrix3Xd expected(3, 8);
  expected << 0, 0, 1, -1, 1, -1, 1, -1,  //
      0, 0, 0, 0, 0, 0, 0, 0,             //
      3, -3, -2, -2, 0, 0, 2, 2;
  EXPECT_LT((points - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SurfacePoints, OfASphereArePolesThenRingsUpwards) {
  const double s = std::sqrt(0.5);
  const Eigen::Matrix3Xd points = surface_points(Sphere{1.0}, {.sphere = {3, 2}});
  Eigen::Matrix3Xd expected(3, 8);
  expected << 0, 0, s, -s, 1, -1, s, -s,  //
      0, 0, 0, 0, 0, 0, 0, 0,             //
      1, -1, -s, -s, 0, 0, s, s;
  EXPECT_LT((points - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(EverySampling, MovesWithTheSizesAsItsRatesSay) {
  for (const Sampling& sampling : every_sampling()) {
    SCOPED_TRACE(sampling.name);
    const Eigen::Matrix3Xd points = surface_points(sampling.shape, sampling.resolution);
    for (int k = 0; k < size_count(sampling.shape); ++k) {
      const auto resized = [&](double step) {
        std::vector<double> sizes = sizes_of(sampling.shape);
        sizes[static_cast<std::size_t>(k)] += step;
        return surface_points(with_sizes(sampling.shape, sizes), sampling.resolution);
      };
      // Points are linear in the sizes: central differences are exact but for rounding.
      const double step = 1.0 / 64.0;
      const Eigen::Matrix3Xd differences = (resized(step) - resized(-step)) / (2.0 * step);
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        EXPECT_LT(
            (surface_point_rate(sampling.shape, points.col(i), k) - differences.col(i)).norm(),
            1e-13);
      }
    }
  }
}

TEST(SurfacePointRate, OfACapsuleIsContinuousWhereItsPartsMeet) {
  const Capsule capsule{0.5, 2.0};
  const double step = 1e-9;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k < 2; ++k) {
      const auto at = [&](double z) {
        return surface_point_rate(capsule, {0.3, 0.4, side * z}, k);
      };
      EXPECT_LT((at(1.0 + step) - at(1.0 - step)).norm(), 5.0 * step);
    }
  }
}

TEST(SurfacePoints, RefusesResolutionsThatAreTooSmall) {
  struct Case {
    Shape shape;
    SurfaceResolution resolution;
    std::string message;
  };
  const std::vector<Case> cases = {
      {Cuboid{},
       {.cuboid = {2, 1, 2}},
       "a cuboid's number of points along a side is 1; it must be at least 2"},
      {Sphere{}, {.sphere = {0, 3}}, "a sphere's number of rings is 0; it must be at least 1"},
      {Sphere{},
       {.sphere = {3, 0}},
       "a sphere's number of points of each ring is 0; it must be at least 1"},
      {Cylinder{},
       {.cylinder = {0, 3}},
       "a cylinder's number of angles is 0; it must be at least 1"},
      {Cylinder{},
       {.cylinder = {8, -1}},
       "a cylinder's number of radii is -1; it must be at least 1"},
      {Capsule{}, {.capsule = {1, 4}}, "a capsule's number of rings is 1; it must be at least 2"},
      {Capsule{},
       {.capsule = {5, 0}},
       "a capsule's number of points of each ring is 0; it must be at least 1"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(
        message_of<InvalidInput>([&] { static_cast<void>(surface_points(c.shape, c.resolution)); }),
        "surface_points: " + c.message);
  }
}

TEST(SurfacePoints, AreCountedBeforeTheyAreMade) {
  for (const Sampling& sampling : every_sampling()) {
    EXPECT_EQ(surface_point_count(sampling.shape, sampling.resolution), sampling.count)
        << sampling.name;
  }
  EXPECT_EQ(surface_points(Cuboid{}, {.cuboid = {2, 2, 250'000}}).cols(), kMaxContactPoints);
}

TEST(SurfacePoints, RefusesMoreThanABodyMayHave) {
  struct Case {
    Shape shape;
    SurfaceResolution resolution;
    std::string count;
  };
  const std::vector<Case> cases = {{Cuboid{}, {.cuboid = {3000, 3000, 3000}}, "5.3964e+07"},
                                   {Cuboid{}, {.cuboid = {2, 2, 250'001}}, "1e+06"},
                                   {Sphere{}, {.sphere = {100'000, 100'000}}, "1e+10"},
                                   {Cylinder{}, {.cylinder = {2'000'000'000, 2}}, "8e+09"},
                                   {Capsule{}, {.capsule = {1000, 2000}}, "2e+06"}};
  for (const Case& c : cases) {
    EXPECT_EQ(
        message_of<InvalidInput>([&] { static_cast<void>(surface_points(c.shape, c.resolution)); }),
        "surface_points: the resolution gives " + c.count + " points; a body has at most 1000000");
  }
}

TEST(SurfacePointRate, RefusesASizeThatIsNotThere) {
  for (const int k : {-1, 1}) {
    EXPECT_EQ(message_of<InvalidInput>([k] {
                static_cast<void>(surface_point_rate(Sphere{1.0}, Eigen::Vector3d::UnitX(), k));
              }),
              concat("surface_point_rate: there is no size ", k, "; this shape has 1"));
  }
}

}  // namespace
}  // namespace hbar
