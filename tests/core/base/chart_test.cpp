#include "hbar/core/base/chart.h"

#include <gtest/gtest.h>

#include "hbar/core/base/rotation.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::differences;
using testing::largest;

constexpr double kPi = std::numbers::pi;

/// Rotation vectors of every length between the singular ones, 0 and 2π.
std::vector<Vector3d> vectors_between_singular_ones() {
  testing::Random random(5);
  std::vector<Vector3d> all;
  for (const double length : {0.3, 1.0, kPi, 4.0, kChartLimit, 5.5, 6.1}) {
    for (int i = 0; i < 5; ++i) {
      all.push_back(length * random.direction());
    }
  }
  return all;
}

TEST(Chart, LimitLiesBetweenHalfATurnAndTheSingularity) {
  EXPECT_GT(kChartLimit, kPi);
  EXPECT_LT(kChartLimit, 2.0 * kPi);
}

TEST(Chart, ChangeIsItsOwnInverse) {
  for (const Vector3d& r : vectors_between_singular_ones()) {
    EXPECT_LT((change_chart(change_chart(r)) - r).norm(), 1e-14) << r.norm();
  }
}

TEST(Chart, ChangeKeepsTheRotation) {
  for (const Vector3d& r : vectors_between_singular_ones()) {
    const Matrix3d R = exp_rotation<double>(r);
    EXPECT_LT(largest(exp_rotation<double>(change_chart(r)) - R), 1e-14) << r.norm();
  }
}

TEST(Chart, ChangeAtTheLimitLeadsWellInside) {
  EXPECT_NEAR(change_chart(kChartLimit * Vector3d::UnitX()).norm(), 0.5 * kPi, 1e-14);
}

TEST(Chart, ChangeKeepsARotationBeyondAFullTurn) {
  const Vector3d r = 7.0 * Vector3d(1.0, 2.0, -2.0) / 3.0;
  EXPECT_LT(change_chart(r).norm(), 1.0);
  EXPECT_LT(largest(exp_rotation<double>(change_chart(r)) - exp_rotation<double>(r)), 1e-14);
}

TEST(Chart, DerivativeIsThatOfTheChange) {
  for (const Vector3d& r : vectors_between_singular_ones()) {
    const Eigen::MatrixXd expected =
        differences([](const Eigen::VectorXd& x) { return change_chart(x); }, r);
    EXPECT_LT(largest(chart_derivative(r) - expected), 1e-9) << r.norm();
  }
}

TEST(Chart, DerivativeKeepsTheAngularVelocity) {
  testing::Random random(6);
  for (const Vector3d& r : vectors_between_singular_ones()) {
    const Vector3d rate = random.vector3(3.0);
    const Vector3d omega = right_jacobian<double>(r) * rate;
    const Vector3d same = right_jacobian<double>(change_chart(r)) * (chart_derivative(r) * rate);
    EXPECT_LT((same - omega).norm(), 2e-14 * (1.0 + rate.norm())) << r.norm();
  }
}

TEST(Chart, DerivativeIsTheInverseOfTheWayBack) {
  for (const Vector3d& r : vectors_between_singular_ones()) {
    const Matrix3d there_and_back = chart_derivative(change_chart(r)) * chart_derivative(r);
    EXPECT_LT(largest(there_and_back - Matrix3d::Identity()), 1e-13) << r.norm();
  }
}

TEST(Chart, SecondDerivativeIsThatOfTheRate) {
  testing::Random random(7);
  for (const Vector3d& r : vectors_between_singular_ones()) {
    const Vector3d rate = random.vector3(3.0);
    const Eigen::MatrixXd expected = differences(
        [&](const Eigen::VectorXd& x) { return Eigen::VectorXd(chart_derivative(x) * rate); }, r);
    const double scale = 1.0 + largest(expected);
    EXPECT_LT(largest(chart_second_derivative(r, rate) - expected), 1e-8 * scale) << r.norm();
  }
}

}  // namespace
}  // namespace hbar
