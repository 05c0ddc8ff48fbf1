#include "hbar/core/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <set>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

Corners flat(const std::vector<Eigen::Vector2d>& points) {
  Corners out;
  for (const Eigen::Vector2d& p : points) {
    out.emplace_back(p.x(), p.y(), 0.0);
  }
  return out;
}

/// By the shoelace formula: independent of any triangulation.
double area_of(const std::vector<Eigen::Vector2d>& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d& q = p[(i + 1) % p.size()];
    twice += p[i].x() * q.y() - p[i].y() * q.x();
  }
  return 0.5 * twice;
}

/// All are of positive area, they add up to the polygon's, every edge of the polygon is one of
/// theirs, and every other edge lies between two.
void expect_triangulation(const std::vector<Eigen::Vector2d>& polygon) {
  const std::vector<std::array<int, 3>> triangles = triangulate(flat(polygon));
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double sum = 0.0;
  std::multiset<std::pair<int, int>> edges;
  for (const std::array<int, 3>& t : triangles) {
    const auto at = [&](std::size_t i) { return polygon[static_cast<std::size_t>(t[i])]; };
    const double area = area_of({at(0), at(1), at(2)});
    EXPECT_GT(area, 0.0);
    sum += area;
    for (std::size_t i = 0; i < 3; ++i) {
      edges.emplace(t[i], t[(i + 1) % 3]);
    }
  }
  EXPECT_NEAR(sum, area_of(polygon), 1e-12 * std::abs(sum));
  const int count = static_cast<int>(polygon.size());
  for (const auto& [from, to] : edges) {
    EXPECT_EQ(edges.count({from, to}), 1U);
    EXPECT_EQ(edges.count({to, from}), (from + 1) % count == to ? 0U : 1U);
  }
}

TEST(Triangulate, EveryStartOfAConcavePolygon) {
  std::vector<Eigen::Vector2d> bracket = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (std::size_t turn = 0; turn < bracket.size(); ++turn) {
    expect_triangulation(bracket);
    std::rotate(bracket.begin(), bracket.begin() + 1, bracket.end());
  }
}

TEST(Triangulate, CornersInTheMiddleOfEdgesStayCorners) {
  expect_triangulation({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}});
  expect_triangulation({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 2}});
  expect_triangulation({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});
  std::vector<Eigen::Vector2d> triangle = {{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}};
  for (std::size_t turn = 0; turn < triangle.size(); ++turn) {
    expect_triangulation(triangle);
    std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
  }
}

TEST(Triangulate, CombsSpiralsAndStars) {
  std::vector<Eigen::Vector2d> comb;
  for (int i = 0; i < 10; ++i) {
    comb.emplace_back(i, 0.0);
    comb.emplace_back(i + 0.5, 5.0);
  }
  comb.emplace_back(10.0, -1.0);
  comb.emplace_back(0.0, -1.0);
  std::reverse(comb.begin(), comb.end());
  expect_triangulation(comb);

  std::vector<Eigen::Vector2d> spiral;
  for (int i = 0; i <= 40; ++i) {
    spiral.emplace_back((1.0 + 0.2 * i) * std::cos(0.5 * i), (1.0 + 0.2 * i) * std::sin(0.5 * i));
  }
  for (int i = 40; i >= 0; --i) {
    spiral.emplace_back((1.6 + 0.2 * i) * std::cos(0.5 * i), (1.6 + 0.2 * i) * std::sin(0.5 * i));
  }
  std::reverse(spiral.begin(), spiral.end());
  expect_triangulation(spiral);

  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  for (const int count : {5, 8, 20, 63, 64, 65, 200, 1000}) {
    std::vector<Eigen::Vector2d> star;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * 3.14159265358979323846 * i / count;
      star.push_back(radius(random) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    expect_triangulation(star);
  }
}

TEST(Triangulate, DoesNotDependOnPlaceSizeAndTurn) {
  const std::vector<Eigen::Vector2d> bracket = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  const auto expected = triangulate(flat(bracket));
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const double size : {1e-6, 1.0, 1e6}) {
    Corners moved = flat(bracket);
    for (Eigen::Vector3d& p : moved) {
      p = R * p * size + Eigen::Vector3d(10.0, -20.0, 30.0) * size;
    }
    EXPECT_EQ(triangulate(moved), expected) << size;
  }
}

TEST(Triangulate, TakesPolygonsThatAreNotQuitePlane) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  Corners bracket = flat({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
  for (Eigen::Vector3d& p : bracket) {
    p.z() = noise(random);
  }
  double sum = 0.0;
  for (const auto& t : triangulate(bracket)) {
    const auto at = [&](std::size_t i) { return bracket[static_cast<std::size_t>(t[i])]; };
    const Eigen::Vector3d twice = (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(twice.z(), 0.0);
    sum += 0.5 * twice.norm();
  }
  EXPECT_NEAR(sum, 3.0, 0.01);
}

TEST(Triangulate, RefusesWhatIsNoPolygon) {
  const auto refusal = [](const std::vector<Eigen::Vector2d>& polygon) {
    return testing::message_of<InvalidInput>(
        [&] { static_cast<void>(triangulate(flat(polygon))); });
  };
  EXPECT_EQ(refusal({{0, 0}, {1, 0}}), "a face of 2 corners; it has at least 3");
  EXPECT_EQ(refusal({{0, 0}, {1, 0}, {2, 0}, {3, 0}}),
            "the corners lie on a line; a face has an area");
  const std::string cuts =
      "the face cuts or touches itself; its corners must bound a simple polygon";
  EXPECT_EQ(refusal({{0, 0}, {2, 2}, {2, 0}, {0, 1}}), cuts);
  EXPECT_EQ(refusal({{0, 0}, {4, 0}, {4, 4}, {2, -1}, {0, 4}}), cuts);
}

}  // namespace
}  // namespace hbar
