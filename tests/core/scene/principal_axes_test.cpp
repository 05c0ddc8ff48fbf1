#include "hbar/core/scene/principal_axes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

TEST(PrincipalAxes, DiagonaliseRightHandedAndAscending) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d any = Eigen::Matrix3d::NullaryExpr([&]() { return uniform(random); });
    const Eigen::Matrix3d inertia = any * any.transpose();
    const PrincipalAxes principal = principal_axes(inertia);
    const Eigen::Matrix3d& R = principal.axes;
    EXPECT_LT((R * principal.moments.asDiagonal() * R.transpose() - inertia).norm(), 1e-14);
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
    EXPECT_LE(principal.moments[0], principal.moments[1]);
    EXPECT_LE(principal.moments[1], principal.moments[2]);
  }
}

TEST(PrincipalAxes, AreTheGivenOnesWhereThoseAscend) {
  const PrincipalAxes principal =
      principal_axes(Eigen::Vector3d(1.0, 2.0, 2.5).asDiagonal().toDenseMatrix());
  EXPECT_EQ(principal.axes, Eigen::Matrix3d::Identity());
  EXPECT_EQ(principal.moments, Eigen::Vector3d(1.0, 2.0, 2.5));
}

TEST(SymmetricMatrix, TakesItsUpperTriangleByRows) {
  Eigen::Matrix3d expected;
  expected << 1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0;
  EXPECT_EQ(symmetric_matrix({1.0, 2.0, 3.0, 4.0, 5.0, 6.0}), expected);
  EXPECT_THROW(static_cast<void>(symmetric_matrix({1.0, 2.0, 3.0})), InvalidInput);
}

}  // namespace
}  // namespace hbar::scene
