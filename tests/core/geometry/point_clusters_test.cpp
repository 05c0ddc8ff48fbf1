#include "hbar/core/geometry/point_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random.h"

namespace hbar {
namespace {

TEST(PointClusters, HoldEveryPointOnceInGroupsOfAFew) {
  testing::Random random(1);
  for (const int count : {1, 7, 12, 13, 100, 1000}) {
    const Eigen::Matrix3Xd points = random.matrix(3, count);
    const PointClusters clusters = cluster_points(points);
    std::vector<int> all = clusters.points;
    std::sort(all.begin(), all.end());
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(all[static_cast<std::size_t>(i)], i);
    }
    EXPECT_EQ(clusters.first.front(), 0);
    EXPECT_EQ(clusters.first.back(), count);
    for (int c = 0; c < clusters.size(); ++c) {
      const auto k = static_cast<std::size_t>(c);
      EXPECT_GE(clusters.first[k + 1] - clusters.first[k], 1);
      EXPECT_LE(clusters.first[k + 1] - clusters.first[k], 12);
    }
  }
}

TEST(PointClusters, AreNoneWithoutPoints) { EXPECT_EQ(cluster_points({}).size(), 0); }

TEST(PointClusters, TakePointsThatCoincide) {
  const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Ones(3, 40);
  EXPECT_EQ(cluster_points(points).points, cluster_points(points).points);
  EXPECT_EQ(cluster_points(points).first.back(), 40);
}

TEST(PointClusters, HaveBallsThatHoldTheirPointsAndNoMuchLargerOnes) {
  testing::Random random(2);
  const Eigen::Matrix3Xd points = random.matrix(3, 500);
  const PointClusters clusters = cluster_points(points);
  Eigen::Matrix4Xd bounds(4, clusters.size());
  bound_clusters(clusters, points, bounds);
  double sum = 0.0;
  for (int c = 0; c < clusters.size(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    double farthest = 0.0;
    for (int j = clusters.first[k]; j < clusters.first[k + 1]; ++j) {
      const int i = clusters.points[static_cast<std::size_t>(j)];
      farthest = std::max(farthest, (points.col(i) - bounds.col(c).head<3>()).norm());
    }
    EXPECT_NEAR(bounds(3, c), farthest, 1e-15);
    sum += farthest;
  }
  EXPECT_LT(sum / clusters.size(), 0.5) << "neighbours, in a cube of side 2";
}

}  // namespace
}  // namespace hbar
