#include "hbar/core/base/rotation.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::largest;
using testing::Random;
using testing::relative_gap;
using testing::slopes;
using testing::with_slope;

/// Rotation vectors of every size that a chart meets, several directions each.
std::vector<Vector3d> vectors_of_every_size() {
  Random random(1);
  std::vector<Vector3d> out;
  for (const double angle : {0.0, 1e-300, 1e-9, 1e-4, 1.0, 2.9999, 3.0, 3.0001, 5.0, 6.0}) {
    for (int k = 0; k < 5; ++k) {
      out.emplace_back(angle * random.direction());
    }
  }
  return out;
}

Vector3<Dual> along(const Vector3d& x, const Vector3d& d) { return with_slope(x, d); }

/// v of a skew matrix [v].
Vector3d unskew(const Matrix3d& m) { return {m(2, 1), m(0, 2), m(1, 0)}; }

TEST(ExpRotation, IsOrthonormalAndTurnsAboutItsVectorByItsLength) {
  for (const Vector3d& r : vectors_of_every_size()) {
    const Matrix3d R = exp_rotation(r);
    EXPECT_LT(largest((R.transpose() * R - Matrix3d::Identity()).eval()), 1e-14) << r;
    EXPECT_GT(R.determinant(), 0.0);
    const Vector3d axis = r.norm() > 0.0 ? Vector3d(r.stableNormalized()) : Vector3d::UnitX();
    const Matrix3d expected = Eigen::AngleAxisd(r.stableNorm(), axis).toRotationMatrix();
    EXPECT_LT(relative_gap(R, expected), 2e-15) << r;
  }
}

TEST(AxisRotation, IsTheExponentialOfAngleTimesAxisWithItsDerivative) {
  Random random(2);
  for (const double angle : {0.0, 1e-8, 0.7, -2.0, 6.0}) {
    const Vector3d axis = random.direction();
    EXPECT_LT(relative_gap(axis_rotation(axis, angle), exp_rotation<double>(angle * axis)), 1e-14);
    const Matrix3<Dual> R = axis_rotation(axis, Dual(angle, 1.0));
    const Matrix3d expected = axis_rotation(axis, angle) * skew(axis);
    EXPECT_LT(relative_gap(slopes(R), expected), 1e-14);
  }
}

TEST(RightJacobian, IsTheDerivativeOfTheExponential) {
  Random random(3);
  for (const Vector3d& r : vectors_of_every_size()) {
    const Vector3d d = random.vector3();
    const Matrix3d dR = slopes(exp_rotation<Dual>(along(r, d)));
    const Matrix3d W = exp_rotation(r).transpose() * dR;
    EXPECT_LT(largest((W + W.transpose()).eval()), 1e-14) << r;
    EXPECT_LT(relative_gap(right_jacobian(r) * d, unskew(W)), 3e-14) << r;
  }
}

TEST(ExponentialRates, AreTheDerivativesOfTheRightJacobian) {
  Random random(4);
  for (const Vector3d& r : vectors_of_every_size()) {
    const Vector3d rate = random.vector3(2.0);
    const Vector3d rate_dot = random.vector3(3.0);
    const ExponentialRates<double> k = exponential_rates(r, rate, rate_dot);
    EXPECT_LT(relative_gap(k.J, right_jacobian(r)), 1e-15);
    const Vector3d J_dot_rate = slopes(right_jacobian<Dual>(along(r, rate))) * rate;
    // Both vanish at r = 0 by cancellation: the gap is relative to the terms, not to their sum.
    const double size = 1e-14 * (rate.squaredNorm() + rate_dot.norm());
    EXPECT_LE(largest(Vector3d(k.J_dot_rate - J_dot_rate)), size) << r;
    for (int i = 0; i < 3; ++i) {
      const Vector3d e = Vector3d::Unit(i);
      const Matrix3d dJ = slopes(right_jacobian<Dual>(along(r, e)));
      EXPECT_LT(relative_gap(k.dJ_dr[static_cast<std::size_t>(i)], dJ), 1e-13) << r;
      EXPECT_LT(relative_gap(k.d_velocity_dr.col(i), dJ * rate), 1e-13) << r;

      const auto moved =
          exponential_rates<Dual>(along(r, e), rate.cast<Dual>(), rate_dot.cast<Dual>());
      const Vector3d by_r =
          slopes(Vector3<Dual>(moved.J * rate_dot.cast<Dual>() + moved.J_dot_rate));
      EXPECT_LE(largest(Vector3d(k.d_acceleration_dr.col(i) - by_r)), size) << r;

      const auto faster =
          exponential_rates<Dual>(r.cast<Dual>(), along(rate, e), rate_dot.cast<Dual>());
      const Vector3d by_rate = slopes(faster.J_dot_rate);
      EXPECT_LE(largest(Vector3d(k.d_acceleration_drate.col(i) - by_rate)), size) << r;
    }
  }
}

TEST(LogRotation, InvertsTheExponential) {
  Random random(5);
  for (const double angle : {0.0, 1e-300, 1e-9, 1e-4, 1.0, 3.0, 3.14}) {
    const Vector3d r = angle * random.direction();
    const Vector3d back = log_rotation(exp_rotation(r));
    EXPECT_LE((back - r).norm(), 1e-14 * (1.0 + angle)) << r;
  }
  for (const double angle : {std::numbers::pi, 4.0, 6.0}) {
    const Matrix3d R = exp_rotation<double>(angle * random.direction());
    EXPECT_LE(log_rotation(R).norm(), std::numbers::pi);
    EXPECT_LT(relative_gap(exp_rotation<double>(log_rotation(R)), R), 3e-15);
  }
}

TEST(RightJacobianInverse, IsTheInverse) {
  for (const Vector3d& r : vectors_of_every_size()) {
    const Matrix3d product = right_jacobian_inverse(r) * right_jacobian(r);
    // Its entries grow towards 2π, where the Jacobian is singular.
    EXPECT_LT(largest((product - Matrix3d::Identity()).eval()), 1e-13) << r;
  }
}

TEST(LogRotation, HasTheDerivativeThatUndoesTheExponentials) {
  Random random(6);
  for (const double angle : {0.0, 1e-300, 1e-9, 1e-4, 1.0, 3.0, 3.1}) {
    const Vector3d r = angle * random.direction();
    const Vector3d rate = random.vector3();
    const Vector3<Dual> back = log_rotation(exp_rotation<Dual>(along(r, rate)));
    EXPECT_LT((slopes(back) - rate).norm(), 1e-13 * rate.norm()) << r;
  }
}

}  // namespace
}  // namespace hbar
