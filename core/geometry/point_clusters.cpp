#include "hbar/core/geometry/point_clusters.h"

#include <algorithm>
#include <numeric>

namespace hbar {
namespace {

constexpr int kLargest = 12;  // points that stay together

void split(const Eigen::Matrix3Xd& points, std::vector<int>::iterator begin,
           std::vector<int>::iterator end, std::vector<int>& ends, int offset) {
  const auto count = static_cast<int>(end - begin);
  if (count <= kLargest) {
    ends.push_back(offset + count);
    return;
  }
  Eigen::Vector3d lower = points.col(*begin);
  Eigen::Vector3d upper = lower;
  for (auto i = begin; i != end; ++i) {
    lower = lower.cwiseMin(points.col(*i));
    upper = upper.cwiseMax(points.col(*i));
  }
  Eigen::Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  const auto middle = begin + count / 2;
  std::nth_element(begin, middle, end, [&](int a, int b) {
    return points(axis, a) < points(axis, b) || (points(axis, a) == points(axis, b) && a < b);
  });
  split(points, begin, middle, ends, offset);
  split(points, middle, end, ends, offset + count / 2);
}

}  // namespace

PointClusters cluster_points(const Eigen::Matrix3Xd& points) {
  PointClusters out;
  out.points.resize(static_cast<std::size_t>(points.cols()));
  std::iota(out.points.begin(), out.points.end(), 0);
  out.first.push_back(0);
  if (points.cols() > 0) {
    split(points, out.points.begin(), out.points.end(), out.first, 0);
  }
  return out;
}

void bound_clusters(const PointClusters& clusters, const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                    Eigen::Ref<Eigen::Matrix4Xd> bounds) {
  for (int c = 0; c < clusters.size(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    Eigen::Vector3d lower =
        points.col(clusters.points[static_cast<std::size_t>(clusters.first[k])]);
    Eigen::Vector3d upper = lower;
    for (int i = clusters.first[k]; i < clusters.first[k + 1]; ++i) {
      const Eigen::Vector3d point = points.col(clusters.points[static_cast<std::size_t>(i)]);
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    const Eigen::Vector3d centre = 0.5 * (lower + upper);
    double squared = 0.0;
    for (int i = clusters.first[k]; i < clusters.first[k + 1]; ++i) {
      const Eigen::Vector3d point = points.col(clusters.points[static_cast<std::size_t>(i)]);
      squared = std::max(squared, (point - centre).squaredNorm());
    }
    bounds.col(c) << centre, std::sqrt(squared);
  }
}

}  // namespace hbar
