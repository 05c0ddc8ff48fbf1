#pragma once

#include <vector>

#include "hbar/core/base/scalar.h"

namespace hbar {

/// Contact points of a body in groups of neighbours, so that whole groups far from a surface can be
/// skipped.
struct PointClusters {
  std::vector<int> points;  ///< every point's index, cluster by cluster
  std::vector<int> first;  ///< of each cluster in `points`, and the end              [clusters + 1]

  [[nodiscard]] int size() const { return static_cast<int>(first.size()) - 1; }
};

/// Splits points at the median of their largest extent until each group is small. Deterministic.
///
/// @param points  in the body frame                                               [3 x points]
[[nodiscard]] PointClusters cluster_points(const Eigen::Matrix3Xd& points);

/// Balls around clusters: centre and radius of each, as a column.
///
/// @param bounds  sized for the clusters                                          [4 x clusters]
void bound_clusters(const PointClusters& clusters, const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                    Eigen::Ref<Eigen::Matrix4Xd> bounds);

}  // namespace hbar
