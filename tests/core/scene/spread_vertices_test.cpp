#include "hbar/core/scene/spread_vertices.h"

#include <gtest/gtest.h>

#include <limits>

namespace hbar::scene {
namespace {

/// A flat square of n x n vertices, two triangles a cell.
TriangleMesh square(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.vertices.emplace_back(i, j, 0.0);
    }
  }
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      const int a = n * i + j;
      mesh.triangles.push_back({a, a + n, a + 1});
      mesh.triangles.push_back({a + 1, a + n, a + n + 1});
    }
  }
  return mesh;
}

double least_gap(const Eigen::Matrix3Xd& points) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      least = std::min(least, (points.col(i) - points.col(j)).norm());
    }
  }
  return least;
}

TEST(SpreadVertices, BeginFarFromTheCentreAndGoOnFarFromEachOther) {
  Eigen::Matrix3Xd expected(3, 5);  // a corner of the mesh's beginning wins ties
  expected << 8, 0, 0, 8, 4,        //
      8, 0, 8, 0, 4,                //
      0, 0, 0, 0, 0;
  EXPECT_EQ(spread_vertices(square(9), {3.0, 3.0, 0.0}, 5), expected);
}

TEST(SpreadVertices, FewerAreTheBeginningOfMore) {
  const TriangleMesh mesh = square(11);
  const Eigen::Matrix3Xd many = spread_vertices(mesh, {5.0, 5.0, 0.0}, 40);
  ASSERT_EQ(many.cols(), 40);
  for (const int count : {0, 1, 7, 39}) {
    EXPECT_EQ(spread_vertices(mesh, {5.0, 5.0, 0.0}, count), many.leftCols(count));
  }
}

TEST(SpreadVertices, LeaveNoLargeHole) {
  // Each vertex left out is nearer to a chosen one than the chosen ones are to each other.
  const TriangleMesh mesh = square(20);
  const Eigen::Matrix3Xd points = spread_vertices(mesh, {0.0, 0.0, 0.0}, 30);
  const double gap = least_gap(points);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_LE((points.colwise() - vertex).colwise().norm().minCoeff(), gap);
  }
}

TEST(SpreadVertices, TakeEachPlaceOnceAndOnlyWhatTrianglesHave) {
  TriangleMesh mesh = square(3);
  mesh.vertices.emplace_back(50.0, 50.0, 50.0);  // in no triangle
  const auto first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < 3; ++i) {
    mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(i)]);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});  // places that are there already
  const Eigen::Matrix3Xd points = spread_vertices(mesh, {1.0, 1.0, 0.0}, 64);
  EXPECT_EQ(points.cols(), 9);
  EXPECT_EQ(least_gap(points), 1.0);
  EXPECT_EQ(spread_vertices(TriangleMesh(), Eigen::Vector3d::Zero(), 4).cols(), 0);
}

}  // namespace
}  // namespace hbar::scene
