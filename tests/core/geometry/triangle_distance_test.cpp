#include "hbar/core/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

#include "hbar/core/base/error.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

/// Rounding of a distance between points of size 1.
constexpr double kRounding = 1e-15;

std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const auto vertex = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  return {vertex(t[0]), vertex(t[1]), vertex(t[2])};
}

/// Distance to a triangle by the regions of barycentric coordinates (Ericson, Real-Time Collision
/// Detection, 2005, 5.1.5).
double triangle_distance(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& x) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const double d1 = ab.dot(x - a);
  const double d2 = ac.dot(x - a);
  const double d3 = ab.dot(x - b);
  const double d4 = ac.dot(x - b);
  const double d5 = ab.dot(x - c);
  const double d6 = ac.dot(x - c);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return (x - a).norm();
  }
  if (d3 >= 0.0 && d4 <= d3) {
    return (x - b).norm();
  }
  if (d6 >= 0.0 && d5 <= d6) {
    return (x - c).norm();
  }
  const double vc = d1 * d4 - d3 * d2;
  const double vb = d5 * d2 - d1 * d6;
  const double va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return (x - a - d1 / (d1 - d3) * ab).norm();
  }
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return (x - a - d2 / (d2 - d6) * ac).norm();
  }
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return (x - b - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  }
  return (x - a - vb / (va + vb + vc) * ab - vc / (va + vb + vc) * ac).norm();
}

/// The solid angle of all triangles is 4π from inside, 0 from outside (Van Oosterom & Strackee,
/// 1983).
bool is_inside(const TriangleMesh& mesh, const Eigen::Vector3d& x) {
  double half_angle = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const auto corners = corners_of(mesh, triangle);
    const Eigen::Vector3d a = (corners[0] - x).normalized();
    const Eigen::Vector3d b = (corners[1] - x).normalized();
    const Eigen::Vector3d c = (corners[2] - x).normalized();
    half_angle += std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return half_angle > std::numbers::pi;
}

double brute_force(const TriangleMesh& mesh, const Eigen::Vector3d& x) {
  double distance = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    distance = std::min(distance, triangle_distance(corners_of(mesh, triangle), x));
  }
  return is_inside(mesh, x) ? -distance : distance;
}

std::string distance_refusal(const TriangleMesh& mesh) {
  try {
    const TriangleDistance distance(mesh);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TriangleDistance, IsExactForABox) {
  const Eigen::Vector3d size(0.8, 1.0, 1.6);
  const TriangleDistance distance(box_mesh(size));
  EXPECT_EQ(distance.box().min(), -size / 2.0);
  EXPECT_EQ(distance.box().max(), size / 2.0);
  std::mt19937 engine(1);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d x = random_point(engine, 1.2);
    EXPECT_NEAR(distance.signed_distance(x), box_distance(size, x), kRounding);
  }
}

TEST(TriangleDistance, IsExactAgainstFacesEdgesAndCornersOfABox) {
  const Eigen::Vector3d size(0.8, 1.0, 1.6);
  const TriangleDistance distance(box_mesh(size));
  int zeros = 0;
  for (int i = 0; i < 125; ++i) {  // every coordinate far, on the surface, inside
    const Eigen::Vector3d steps(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
    const Eigen::Vector3d x = steps.array() * size.array() / 2.0;
    const double expected = box_distance(size, x);
    EXPECT_NEAR(distance.signed_distance(x), expected, kRounding) << x.transpose();
    if (expected == 0.0) {
      EXPECT_EQ(distance.signed_distance(x), 0.0) << x.transpose();
      ++zeros;
    }
  }
  EXPECT_EQ(zeros, 26);  // 6 faces, 12 edges, 8 corners
}

TEST(TriangleDistance, LiesWithinTheSagOfAnIcosphere) {
  const TriangleMesh mesh = icosphere(2.0, 3);
  const TriangleDistance distance(mesh);
  double inner = 2.0;  // the planes of the triangles come this close to the centre
  for (const auto& triangle : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, triangle);
    inner = std::min(inner, (b - a).cross(c - a).normalized().dot(a));
  }
  EXPECT_GT(inner, 1.98);
  std::mt19937 engine(2);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d x = random_point(engine, 3.0);
    const double found = distance.signed_distance(x);
    EXPECT_GT(found, x.norm() - 2.0 - kRounding);
    EXPECT_LT(found, x.norm() - inner + kRounding);
  }
}

TEST(TriangleDistance, AgreesWithEveryTriangleAndTheSolidAngleOfSpikyStars) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const TriangleMesh mesh = star_mesh(2, seed);
    const TriangleDistance distance(mesh);
    std::mt19937 engine(seed);
    int inside = 0;
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d x = random_point(engine, 1.5);
      const double expected = brute_force(mesh, x);
      EXPECT_NEAR(distance.signed_distance(x), expected, kRounding) << seed << ": " << i;
      inside += expected < 0.0 ? 1 : 0;
    }
    EXPECT_GT(inside, 50);
  }
}

TEST(TriangleDistance, HasTheRightSignNearAcuteEdgesAndCorners) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const TriangleMesh mesh = star_mesh(1, seed);
    const TriangleDistance distance(mesh);
    std::mt19937 engine(seed);
    for (const double near : {1e-1, 1e-3, 1e-6}) {
      for (int i = 0; i < 1000; ++i) {
        const auto& triangle = mesh.triangles[static_cast<std::size_t>(i) % mesh.triangles.size()];
        const auto [a, b, c] = corners_of(mesh, triangle);
        const Eigen::Vector3d on = i % 2 == 0 ? a : (a + b) / 2.0;
        const Eigen::Vector3d x = on + random_point(engine, near);
        const double found = distance.signed_distance(x);
        // So near the surface, rounding can decide the solid angle.
        if (std::abs(found) > 1e-12) {
          EXPECT_EQ(found < 0.0, is_inside(mesh, x)) << found;
        }
      }
    }
  }
}

TEST(TriangleDistance, HasTheRightSignAtTheTipOfANeedle) {
  // Beyond the tip, the nearest triangles' own normals disagree about the side.
  const TriangleMesh needle = {
      {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}, {0.2, 0.1, 1.0}},
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const TriangleDistance distance(needle);
  std::mt19937 engine(5);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d x = Eigen::Vector3d(0.2, 0.1, 1.0) + random_point(engine, 0.02);
    const double expected = brute_force(needle, x);
    EXPECT_NEAR(distance.signed_distance(x), expected, kRounding);
  }
}

TEST(TriangleDistance, MovesWithTheMesh) {
  TriangleMesh mesh = star_mesh(2, 7);
  const TriangleDistance distance(mesh);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d p(100.0, -200.0, 300.0);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = R * vertex + p;
  }
  const TriangleDistance moved(mesh);
  std::mt19937 engine(7);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d x = random_point(engine, 2.0);
    // The vertices themselves are rounded to 6e-14.
    EXPECT_NEAR(moved.signed_distance(R * x + p), distance.signed_distance(x), 2e-13);
  }
}

TEST(TriangleDistance, DoesNotDependOnTheHint) {
  const TriangleMesh mesh = star_mesh(2, 8);
  const TriangleDistance distance(mesh);
  std::mt19937 engine(8);
  int hint = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d x = random_point(engine, 2.0);
    EXPECT_NEAR(distance.signed_distance(x, hint), distance.signed_distance(x), kRounding);
    EXPECT_LT(hint, static_cast<int>(mesh.triangles.size()));
  }
}

TEST(TriangleDistance, PassesOnWhatIsNotANumber) {
  const TriangleDistance distance(box_mesh({1.0, 1.0, 1.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(distance.signed_distance({0.0, nan, 0.0})));
}

TEST(TriangleDistance, MergesLooseTriangles) {
  const Eigen::Vector3d size(0.8, 1.0, 1.6);
  const TriangleMesh mesh = box_mesh(size);
  TriangleMesh loose;
  for (const auto& triangle : mesh.triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const Eigen::Vector3d& corner : corners_of(mesh, triangle)) {
      loose.vertices.push_back(corner);
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  const TriangleDistance distance(loose);
  EXPECT_EQ(distance.signed_distance({0.0, 0.0, 0.0}), -0.4);
}

TEST(TriangleDistance, RefusesWhatBoundsNoSolidAndSaysWhere) {
  TriangleMesh mesh = box_mesh({1.0, 1.0, 1.0});
  mesh.triangles.pop_back();
  EXPECT_EQ(distance_refusal(mesh),
            "mesh: the edge from (0.5, -0.5, 0.5) to (0.5, 0.5, 0.5) has one triangle; a closed "
            "surface has two at each edge");
  mesh = box_mesh({1.0, 1.0, 1.0});
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  EXPECT_EQ(
      distance_refusal(mesh).substr(0, 87),
      "mesh: the edge from (0.5, -0.5, 0.5) to (-0.5, 0.5, 0.5) has two triangles of opposite ");
  mesh = box_mesh({1.0, 1.0, 1.0});
  mesh.triangles[3][0] = 8;
  EXPECT_EQ(distance_refusal(mesh), "mesh: triangle 4 has vertex 9; there are 8");
  mesh = box_mesh({1.0, 1.0, 1.0});
  mesh.triangles.pop_back();
  mesh.vertices[7].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(distance_refusal(mesh),
            "mesh: vertex 8 is (inf, 0.5, 0.5); coordinates must be finite");
  EXPECT_EQ(distance_refusal({}), "mesh: no triangle; a solid needs at least 4");
}

/// Several boxes in one mesh, with vertices of equal coordinates shared.
TriangleMesh boxes(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& centre_size) {
  TriangleMesh all;
  for (const auto& [centre, size] : centre_size) {
    all = together(std::move(all), moved(box_mesh(size), centre));
  }
  return merge_equal_vertices(all);
}

const Eigen::Vector3d kUnit = Eigen::Vector3d::Ones();

/// Two cubes that share an edge along z.
TriangleMesh at_an_edge() { return boxes({{{-0.5, -0.5, 0.0}, kUnit}, {{0.5, 0.5, 0.0}, kUnit}}); }

/// Two cubes that share a vertex.
TriangleMesh at_a_vertex() {
  return boxes({{{-0.5, -0.5, -0.5}, kUnit}, {{0.5, 0.5, 0.5}, kUnit}});
}

/// The distance to a union of boxes by that to each: exact outside; inside, where they do not
/// overlap, too.
double union_distance(const std::vector<Eigen::Vector3d>& centres, const Eigen::Vector3d& x) {
  double least = 1e300;
  for (const Eigen::Vector3d& centre : centres) {
    least = std::min(least, box_distance(kUnit, x - centre));
  }
  return least;
}

TEST(TriangleDistance, OfSolidsThatTouchIsThatOfTheUnion) {
  std::mt19937 random(1);
  const TriangleDistance edge(at_an_edge());
  const TriangleDistance vertex(at_a_vertex());
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d x = random_point(random, 1.6);
    EXPECT_NEAR(edge.signed_distance(x), union_distance({{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}}, x),
                1e-14);
    EXPECT_NEAR(vertex.signed_distance(x), union_distance({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, x),
                1e-14);
  }
}

/// A cube of 3 with two cubic cavities of 1 that touch along an edge.
TEST(TriangleDistance, CavitiesThatTouchAreOutside) {
  TriangleMesh mesh = box_mesh({3.0, 3.0, 3.0});
  const std::vector<Eigen::Vector3d> centres = {{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}};
  for (const Eigen::Vector3d& centre : centres) {
    mesh = together(std::move(mesh), turned_inside_out(moved(box_mesh(kUnit), centre)));
  }
  const TriangleDistance distance(merge_equal_vertices(mesh));
  std::mt19937 random(2);
  int within = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d x = random_point(random, 1.9);
    const double expected = std::max(box_distance({3.0, 3.0, 3.0}, x), -union_distance(centres, x));
    const double found = distance.signed_distance(x);
    EXPECT_EQ(found < 0.0, expected < 0.0) << x.transpose();
    within += found < 0.0 ? 1 : 0;
  }
  EXPECT_GT(within, 500);
}

}  // namespace
}  // namespace hbar
