#include "hbar/core/geometry/distance_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hbar/core/base/checksum.h"
#include "hbar/core/base/error.h"
#include "hbar/core/geometry/triangle_distance.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
};

/// Smooth, sharp, spiky, thinner than a cell; far from the origin.
std::vector<NamedMesh> named_meshes() {
  std::vector<NamedMesh> list = {{"ball", icosphere(1.0, 3)},
                                 {"box", box_mesh({2.0, 1.5, 1.0})},
                                 {"plate", box_mesh({2.0, 2.0, 0.02})},
                                 {"rod", box_mesh({0.02, 2.0, 0.02})},
                                 {"star", star_mesh(2, 1)}};
  list.push_back({"moved", star_mesh(1, 2)});
  for (Eigen::Vector3d& vertex : list.back().mesh.vertices) {
    vertex.array() += 100.0;
  }
  return list;
}

/// A point up to `beyond` lengths of its longest side outside a mesh's bounding box.
Eigen::Vector3d point_around(std::mt19937& engine, const Eigen::AlignedBox3d& box, double beyond) {
  const Eigen::Vector3d half = box.sizes().array() / 2.0 + beyond * box.sizes().maxCoeff();
  return box.center().array() + random_point(engine, 1.0).array() * half.array();
}

std::string refusal(std::string_view bytes) {
  try {
    const DistanceGrid grid(bytes);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal(const TriangleMesh& mesh, int cells) {
  try {
    const DistanceGrid grid(mesh, cells);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DistanceGrid, IsExactAtItsNodes) {
  for (const auto& [name, mesh] : named_meshes()) {
    const TriangleDistance exact(mesh);
    const DistanceGrid grid(mesh, 12);
    const GridNodes& nodes = grid.nodes();
    EXPECT_EQ((nodes.count.array() - 7).maxCoeff(), 12) << name;
    const double scale = nodes.last().cwiseAbs().maxCoeff();
    for (int k = 0; k < nodes.count.z(); ++k) {
      for (int i = 0; i < nodes.count.x(); ++i) {
        const Eigen::Vector3d x = nodes.point(i, nodes.count.y() / 2, k);
        EXPECT_NEAR(grid.sample(x).distance, exact.signed_distance(x), 1e-14 * scale) << name;
      }
    }
  }
}

TEST(DistanceGrid, TellsItsErrorNearTheSurface) {
  for (const auto& [name, mesh] : named_meshes()) {
    const TriangleDistance exact(mesh);
    const DistanceGrid grid(mesh, 24);
    const double cell = grid.nodes().spacing;
    EXPECT_LT(grid.max_error(), 0.5 * cell) << name;
    std::mt19937 engine(1);
    double largest = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const Eigen::Vector3d x = point_around(engine, exact.box(), 0.05);
      const double distance = exact.signed_distance(x);
      if (std::abs(distance) > 2.0 * cell) {
        continue;
      }
      largest = std::max(largest, std::abs(grid.sample(x).distance - distance));
    }
    // Not every point is a centre of a cell; where a kink passes is the grid's luck.
    EXPECT_LT(largest, 1.5 * grid.max_error()) << name;
    EXPECT_GT(largest, 0.5 * grid.max_error()) << name;
  }
}

TEST(DistanceGrid, IsAsGoodAsSaidForABallAndABox) {
  // The ball's own edges, of 4 degrees, are what is left.
  EXPECT_LT(DistanceGrid(icosphere(1.0, 4), 24).max_error(), 1e-3);
  // Along a sharp edge the error is a sixth of a cell, whatever the cell is.
  for (const int cells : {12, 24}) {
    const DistanceGrid grid(box_mesh({2.0, 1.5, 1.0}), cells);
    EXPECT_NEAR(grid.max_error() / grid.nodes().spacing, 0.165, 0.005);
  }
}

TEST(DistanceGrid, ConvergesWithOrderFourWhereTheDistanceIsSmooth) {
  // A cube whose top has a dent down to the origin: under its tip the distance is that to the tip.
  TriangleMesh mesh = box_mesh({1.0, 1.0, 1.0});
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  const Eigen::Vector3d centre(0.0, 0.0, -0.15);
  std::array<double, 2> errors = {};
  for (const std::size_t fine : {0U, 1U}) {
    const DistanceGrid grid(mesh, fine == 0 ? 48 : 96);
    std::mt19937 engine(2);
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d x = centre + random_point(engine, 0.01);
      errors[fine] = std::max(errors[fine], std::abs(grid.sample(x).distance + x.norm()));
    }
  }
  // The nearest kinks, a cone's length of 0.08 away, are felt less in finer cells: better than 2⁴.
  EXPECT_GT(errors[0] / errors[1], 14.0);
  EXPECT_LT(errors[1], 1e-7);
}

TEST(DistanceGrid, EveryDerivativeIsThatOfTheOneBefore) {
  for (const auto& [name, mesh] : named_meshes()) {
    const TriangleDistance exact(mesh);
    const DistanceGrid grid(mesh, 16);
    const double cell = grid.nodes().spacing;
    const double step = 1e-5 * cell;
    // Rounding of a distance between points far from the origin, which differences magnify.
    const double rounding = 1e-14 * grid.nodes().last().cwiseAbs().maxCoeff();
    std::mt19937 engine(3);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d x = point_around(engine, exact.box(), 0.4);  // outside the grid, too
      const Eigen::Vector3d d = random_point(engine, 1.0);
      const auto after = grid.sample(x + step * d);
      const auto before = grid.sample(x - step * d);
      const auto here = grid.sample(x);
      const Eigen::Matrix3d slope = grid.hessian_slope(x, d);
      const Eigen::Vector3d turn = (after.gradient - before.gradient) / (2.0 * step);
      const Eigen::Matrix3d bend = (after.hessian - before.hessian) / (2.0 * step);
      EXPECT_NEAR((after.distance - before.distance) / (2.0 * step), here.gradient.dot(d),
                  1e-8 + rounding / step)
          << name;
      EXPECT_LT((turn - here.hessian * d).norm(), (1e-4 + rounding / step) / cell) << name;
      EXPECT_LT((bend - slope).norm(), (1e-4 + rounding / step) / (cell * cell)) << name;
    }
  }
}

TEST(DistanceGrid, IsTwiceContinuouslyDifferentiableAcrossCells) {
  for (const auto& [name, mesh] : named_meshes()) {
    const DistanceGrid grid(mesh, 12);
    const GridNodes& nodes = grid.nodes();
    const double gap = 1e-9 * nodes.spacing;
    std::mt19937 engine(4);
    for (int axis = 0; axis < 3; ++axis) {
      for (int node = -4; node < nodes.count[axis] + 4; ++node) {  // past the ends of the grid, too
        Eigen::Vector3d x = point_around(engine, {nodes.origin, nodes.last()}, 0.3);
        const double border = nodes.origin[axis] + node * nodes.spacing;
        x[axis] = border - gap;
        const auto before = grid.sample(x);
        x[axis] = border + gap;
        const auto after = grid.sample(x);
        EXPECT_NEAR(before.distance, after.distance, 1e-8 * nodes.spacing) << name;
        EXPECT_LT((before.gradient - after.gradient).norm(), 1e-7) << name;
        EXPECT_LT((before.hessian - after.hessian).norm(), 1e-6 / nodes.spacing) << name;
      }
    }
  }
}

TEST(DistanceGrid, LowerBoundIsNegativeOnlyWhereTheDistanceIs) {
  for (const auto& [name, mesh] : named_meshes()) {
    const TriangleDistance exact(mesh);
    const DistanceGrid grid(mesh, 16);
    const Eigen::AlignedBox3d domain(grid.nodes().origin, grid.nodes().last());
    std::mt19937 engine(5);
    int outside = 0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d x = point_around(engine, exact.box(), i % 2 == 0 ? 0.3 : 10.0);
      const double bound = grid.lower_bound(x);
      const double distance = grid.sample(x).distance;
      if (domain.contains(x)) {
        EXPECT_NEAR(bound, distance, 1e-14) << name;
        continue;
      }
      ++outside;
      const double true_distance = exact.signed_distance(x);
      EXPECT_GT(bound, 2.9 * grid.nodes().spacing) << name;
      EXPECT_LE(bound, true_distance * (1.0 + 1e-14)) << name;
      EXPECT_GT(distance, 0.5 * true_distance) << name;
      EXPECT_LT(distance, 2.0 * true_distance) << name;
    }
    EXPECT_GT(outside, 500) << name;
  }
}

TEST(DistanceGrid, IsPositiveBeyondTheSolid) {
  // Also where the grid is too coarse to see it: ripples do not reach a cell beyond the surface.
  for (const auto& [name, mesh] : named_meshes()) {
    const TriangleDistance exact(mesh);
    const DistanceGrid grid(mesh, 8);
    std::mt19937 engine(6);
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d x = point_around(engine, exact.box(), 1.0);
      if (exact.signed_distance(x) > grid.nodes().spacing) {
        EXPECT_GT(grid.sample(x).distance, 0.0) << name;
      }
    }
  }
}

TEST(DistanceGrid, StaysFiniteFarAwayAndPassesOnWhatIsNotANumber) {
  const DistanceGrid grid(icosphere(1.0, 1), 8);
  const Eigen::Vector3d far(1e9, -2e9, 3e9);
  const auto sample = grid.sample(far);
  EXPECT_NEAR(sample.distance, 6e9, 10.0);  // the sum along the axes
  EXPECT_LT((sample.gradient - Eigen::Vector3d(1.0, -1.0, 1.0)).norm(), 1e-12);
  EXPECT_LT(sample.hessian.norm(), 1e-12);
  EXPECT_NEAR(grid.lower_bound(far), far.norm(), 10.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(grid.lower_bound({nan, nan, nan})));
  EXPECT_TRUE(std::isnan(grid.sample({0.0, nan, 0.0}).distance));
}

TEST(DistanceGrid, ComesBackFromItsBytesBitByBit) {
  for (const auto& [name, mesh] : named_meshes()) {
    const DistanceGrid grid(mesh, 8);
    const std::string bytes = grid.bytes();
    const DistanceGrid same{std::string_view(bytes)};
    EXPECT_EQ(same.bytes(), bytes) << name;
    EXPECT_EQ(same.nodes(), grid.nodes()) << name;
    EXPECT_EQ(same.max_error(), grid.max_error()) << name;
    std::mt19937 engine(7);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d x = point_around(engine, {mesh.vertices[0], mesh.vertices[1]}, 2.0);
      EXPECT_EQ(same.lower_bound(x), grid.lower_bound(x)) << name;
      EXPECT_EQ(same.sample(x).hessian, grid.sample(x).hessian) << name;
    }
  }
}

TEST(DistanceGrid, RefusesBytesThatAreCutShortOrAltered) {
  const std::string bytes = DistanceGrid(icosphere(1.0, 1), 4).bytes();
  EXPECT_EQ(refusal(bytes), "accepted");
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 97) {
    EXPECT_NE(refusal(bytes.substr(0, size)), "accepted") << size;
  }
  EXPECT_NE(refusal(bytes + '\0'), "accepted");
  for (std::size_t place = 0; place < bytes.size(); place += place < 300 ? 1 : 97) {
    std::string altered = bytes;
    altered[place] = static_cast<char>(altered[place] ^ (1 << place % 8));
    EXPECT_NE(refusal(altered), "accepted") << place;
  }
}

TEST(DistanceGrid, SaysWhatIsWrongWithItsBytes) {
  const std::string bytes = DistanceGrid(icosphere(1.0, 1), 4).bytes();
  EXPECT_EQ(refusal("nonsense"), "distance grid: the data is not that of a distance grid");
  EXPECT_EQ(refusal(bytes.substr(0, 20)), "distance grid: the data is cut short");
  std::string altered = bytes;
  altered[8] = 2;
  EXPECT_EQ(refusal(altered),
            "distance grid: the data is of version 2; this program reads version 1");
  altered = bytes;
  altered[18] = 1;
  EXPECT_EQ(refusal(altered), "distance grid: the data tells of 65547 nodes on an axis");
  EXPECT_EQ(refusal(bytes.substr(0, bytes.size() - 1)),
            "distance grid: 17583 bytes where the coefficients of 11 11 11 nodes take 17584");
  altered = bytes;
  altered[1000] = static_cast<char>(altered[1000] ^ 1);
  EXPECT_EQ(refusal(altered), "distance grid: the data does not agree with its checksum");
}

/// Bytes in which a number is another one, with the checksum of that.
std::string forged(std::string bytes, std::size_t place, double number) {
  const auto put = [&](std::size_t at, const auto& value) {
    const auto part = std::bit_cast<std::array<char, sizeof value>>(value);
    std::copy(part.begin(), part.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  };
  put(place, number);
  Checksum sum;
  sum.add(std::string_view(bytes).substr(0, bytes.size() - sizeof sum.value()));
  put(bytes.size() - sizeof sum.value(), sum.value());
  return bytes;
}

TEST(DistanceGrid, RefusesNumbersOfNoMeshWhateverTheirChecksum) {
  const std::string bytes = DistanceGrid(icosphere(1.0, 1), 4).bytes();
  const char* const reason = "distance grid: the data holds numbers that no mesh leads to";
  const double infinity = std::numeric_limits<double>::infinity();
  // Eight bytes each: magic, version, three counts, origin, spacing, box, error, coefficients.
  constexpr std::size_t kOrigin = 40;
  constexpr std::size_t kSpacing = 64;
  constexpr std::size_t kLow = 72;
  constexpr std::size_t kHigh = 96;
  constexpr std::size_t kError = 120;
  constexpr std::size_t kCoefficients = 128;
  EXPECT_EQ(refusal(forged(bytes, kError, 0.25)), "accepted");
  for (const std::size_t place : {kOrigin, kSpacing, kLow, kHigh, kError, kCoefficients}) {
    for (const double number : {std::nan(""), infinity, -infinity, 1e300}) {
      const bool may_be = place == kError && number == 1e300;
      EXPECT_EQ(refusal(forged(bytes, place, number)), may_be ? "accepted" : reason)
          << number << " at " << place;
    }
  }
  for (const double spacing : {0.0, -0.5, 5e-324, 1e-3}) {
    EXPECT_EQ(refusal(forged(bytes, kSpacing, spacing)), reason) << spacing;
  }
  EXPECT_EQ(refusal(forged(bytes, kError, -1e-3)), reason);
}

TEST(DistanceGrid, RefusesAbsurdNumbersOfCellsAndOpenSurfaces) {
  const TriangleMesh box = box_mesh({1.0, 1.0, 1.0});
  EXPECT_EQ(refusal(box, 1000),
            "distance grid: 1000 cells along the longest side; 4 to 256 are allowed, and n take up "
            "to 8 (n + 9)^3 bytes");
  EXPECT_NE(refusal(box, 3), "accepted");
  EXPECT_EQ(refusal(box, 4), "accepted");
  TriangleMesh open = box;
  open.triangles.pop_back();
  EXPECT_EQ(refusal(open, 8),
            "mesh: the edge from (0.5, -0.5, 0.5) to (0.5, 0.5, 0.5) has one triangle; a closed "
            "surface has two at each edge");
}

TEST(MeshDistance, IsTheGrid) {
  const TriangleMesh mesh = star_mesh(1, 3);
  const auto field = mesh_distance(mesh, 8);
  const DistanceGrid grid(mesh, 8);
  EXPECT_EQ(field->lower_bound({0.1, 0.2, 0.3}), grid.lower_bound({0.1, 0.2, 0.3}));
  EXPECT_LT(mesh_distance(mesh)->lower_bound({0.1, 0.2, 0.3}), 0.0);
}

TEST(Checksum, IsFnv1a) {
  Checksum sum;
  EXPECT_EQ(sum.value(), 0xcbf29ce484222325U);
  sum.add("foobar");
  EXPECT_EQ(sum.value(), 0x85944171f73967e8U);  // the value its authors publish
  Checksum number;
  number.add(std::int32_t{0x64636261});
  Checksum letters;
  letters.add(std::endian::native == std::endian::little ? "abcd" : "dcba");
  EXPECT_EQ(number.value(), letters.value());
}

TEST(DistanceGrid, EndsWhenAsked) {
  std::atomic<bool> stop = true;
  const TriangleMesh mesh = icosphere(1.0, 1);
  EXPECT_EQ(testing::message_of<Interrupted>([&] { DistanceGrid(mesh, 4, &stop); }),
            "distance grid interrupted at plane 1 of 11");
  stop = false;
  EXPECT_EQ(DistanceGrid(mesh, 4, &stop).bytes(), DistanceGrid(mesh, 4).bytes());
}

}  // namespace
}  // namespace hbar
