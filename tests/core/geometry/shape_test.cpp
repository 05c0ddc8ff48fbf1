#include "hbar/core/geometry/shape.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

using testing::message_of;

/// A slice of a solid at height z: its area and ∫x² dA, ∫y² dA.
struct Slice {
  double area;
  double xx;
  double yy;
};

Slice disc(double radius_squared) {
  const double quarter = 0.25 * std::numbers::pi * radius_squared * radius_squared;
  return {std::numbers::pi * radius_squared, quarter, quarter};
}

/// A solid as slices between heights; between two heights they are polynomials of z.
struct SlicedSolid {
  std::string name;
  Shape shape;
  std::vector<double> heights;
  std::function<Slice(double)> slice;
};

std::vector<SlicedSolid> every_sliced_solid() {
  return {
      {"cuboid",
       Cuboid{{1.0, 2.0, 3.0}},
       {-1.5, 1.5},
       [](double) {
         return Slice{2.0, 2.0 / 12.0, 8.0 / 12.0};
       }},
      {"sphere", Sphere{0.7}, {-0.7, 0.7}, [](double z) { return disc(0.49 - z * z); }},
      {"cylinder", Cylinder{0.3, 1.4}, {-0.7, 0.7}, [](double) { return disc(0.09); }},
      {"capsule",
       Capsule{0.3, 1.4},
       {-1.0, -0.7, 0.7, 1.0},
       [](double z) {
         const double beyond = std::max(std::abs(z) - 0.7, 0.0);
         return disc(0.09 - beyond * beyond);
       }},
  };
}

/// Mass and ∫x², ∫y², ∫z² dm by Gauss-Legendre quadrature, exact for these slices.
Eigen::Vector4d integrate(const SlicedSolid& solid, double density) {
  constexpr std::array<double, 5> kNodes = {-0.906179845938663993, -0.538469310105683091, 0.0,
                                            0.538469310105683091, 0.906179845938663993};
  constexpr std::array<double, 5> kWeights = {0.236926885056189088, 0.478628670499366468,
                                              0.568888888888888889, 0.478628670499366468,
                                              0.236926885056189088};
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t part = 0; part + 1 < solid.heights.size(); ++part) {
    const double half = 0.5 * (solid.heights[part + 1] - solid.heights[part]);
    const double middle = 0.5 * (solid.heights[part + 1] + solid.heights[part]);
    for (std::size_t k = 0; k < kNodes.size(); ++k) {
      const double z = middle + half * kNodes[k];
      const Slice slice = solid.slice(z);
      sum += density * half * kWeights[k] *
             Eigen::Vector4d(slice.area, slice.xx, slice.yy, slice.area * z * z);
    }
  }
  return sum;
}

TEST(EverySolid, HasTheMassAndMomentsOfItsSlices) {
  const double density = 2.5;
  for (const SlicedSolid& solid : every_sliced_solid()) {
    const MassProperties properties = solid_mass_properties(solid.shape, density);
    const Eigen::Vector4d sums = integrate(solid, density);
    const Eigen::Vector3d moments(sums[2] + sums[3], sums[1] + sums[3], sums[1] + sums[2]);
    EXPECT_NEAR(properties.mass, sums[0], 1e-14 * sums[0]) << solid.name;
    EXPECT_LT(testing::relative_gap(properties.inertia, moments), 1e-14) << solid.name;
  }
}

TEST(EverySolid, GrowsWithItsSizesAsDualNumbersDo) {
  for (const SlicedSolid& solid : every_sliced_solid()) {
    const std::vector<double> lengths = sizes_of(solid.shape);
    for (int k = 0; k < size_count(solid.shape); ++k) {
      Eigen::Vector3d sizes = Eigen::Vector3d::Zero();
      Vector3<Dual> moved = Vector3<Dual>::Zero();
      for (int i = 0; i < size_count(solid.shape); ++i) {
        sizes[i] = lengths[static_cast<std::size_t>(i)];
        moved[i] = {sizes[i], i == k ? 1.0 : 0.0};
      }
      const UnitSolid<Dual> expected = unit_solid<Dual>(solid.shape, moved);
      const UnitSolid<double> rate = unit_solid_rate<double>(solid.shape, sizes, k);
      EXPECT_NEAR(rate.mass, expected.mass.slope, 1e-14 * expected.mass.slope) << solid.name;
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(rate.moments[i], expected.moments[i].slope, 1e-13 * rate.moments.norm())
            << solid.name << ", size " << k << ", moment " << i;
      }
    }
  }
}

TEST(SolidMassProperties, RefusesWhatIsNoSolid) {
  const double nan = std::nan("");
  struct Case {
    Shape shape;
    double density;
    std::string message;
  };
  const std::vector<Case> cases = {
      {NoShape{}, 1.0, "a body without a shape has no volume; give its mass"},
      {Sphere{1.0}, 0.0, "the density is 0; it must be positive and finite"},
      {Sphere{1.0}, nan, "the density is nan; it must be positive and finite"},
      {Cuboid{{1.0, -2.0, 1.0}}, 1.0, "size.y is -2; it must be positive and finite"},
      {Sphere{0.0}, 1.0, "radius is 0; it must be positive and finite"},
      {Cylinder{-1.0, 1.0}, 1.0, "radius is -1; it must be positive and finite"},
      {Cylinder{1.0, 0.0}, 1.0, "length is 0; it must be positive and finite"},
      {Capsule{0.0, 1.0}, 1.0, "radius is 0; it must be positive and finite"},
      {Capsule{1.0, 1.0 / 0.0}, 1.0, "length is inf; it must be positive and finite"},
  };
  for (const Case& bad : cases) {
    EXPECT_EQ(message_of<InvalidInput>(
                  [&] { static_cast<void>(solid_mass_properties(bad.shape, bad.density)); }),
              "solid_mass_properties: " + bad.message);
  }
}

TEST(EveryShape, NamesItsSizesAndTakesOthers) {
  struct Case {
    Shape shape;
    std::vector<double> sizes;
    std::vector<std::string> names;
    std::vector<double> others;
    Shape resized;
  };
  const std::vector<Case> cases = {
      {NoShape{}, {}, {}, {}, NoShape{}},
      {Cuboid{{1.0, 2.0, 3.0}},
       {1.0, 2.0, 3.0},
       {"size.x", "size.y", "size.z"},
       {4.0, 5.0, 6.0},
       Cuboid{{4.0, 5.0, 6.0}}},
      {Sphere{1.5}, {1.5}, {"radius"}, {2.5}, Sphere{2.5}},
      {Cylinder{0.5, 2.0}, {0.5, 2.0}, {"radius", "length"}, {3.0, 4.0}, Cylinder{3.0, 4.0}},
      {Capsule{0.5, 2.0}, {0.5, 2.0}, {"radius", "length"}, {3.0, 4.0}, Capsule{3.0, 4.0}},
  };
  ASSERT_EQ(cases.size(), std::variant_size_v<Shape>);
  for (const Case& c : cases) {
    EXPECT_EQ(sizes_of(c.shape), c.sizes);
    EXPECT_EQ(size_names(c.shape), c.names);
    EXPECT_EQ(size_count(c.shape), static_cast<int>(c.sizes.size()));
    EXPECT_EQ(with_sizes(c.shape, c.others), c.resized);
    EXPECT_EQ(with_sizes(c.shape, c.sizes), c.shape);
  }
}

TEST(WithSizes, RefusesAnotherNumberOfLengths) {
  const std::vector<double> sizes = {1.0};
  EXPECT_EQ(message_of<InvalidInput>([&] {
              static_cast<void>(with_sizes(Capsule{1.0, 1.0}, sizes));
            }),
            "with_sizes: got 1 lengths; this shape has 2");
}

}  // namespace
}  // namespace hbar
