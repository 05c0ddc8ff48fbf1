#include "hbar/core/base/spatial.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/spatial_matrices.h"

namespace hbar {
namespace {

using testing::adjoint;
using testing::Matrix6d;
using testing::Random;
using testing::relative_gap;
using testing::twist_cross_matrix;
using Vector6d = Vector6<double>;

RigidTransform<double> pose(Random& random) { return {random.rotation(), random.vector3()}; }

TEST(RigidTransform, ComposesAndInvertsAsHomogeneousMatrices) {
  Random random(1);
  const auto matrix = [](const RigidTransform<double>& X) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = X.R;
    m.topRightCorner<3, 1>() = X.p;
    return m;
  };
  const RigidTransform<double> X_AB = pose(random);
  const RigidTransform<double> X_BC = pose(random);
  EXPECT_LT(relative_gap(matrix(X_AB * X_BC), matrix(X_AB) * matrix(X_BC)), 1e-15);
  EXPECT_LT(relative_gap(matrix(inverse(X_AB)), matrix(X_AB).inverse()), 1e-14);
  EXPECT_TRUE(X_AB == X_AB);
  EXPECT_FALSE(X_AB == X_BC);
}

TEST(CrossTwist, IsTheMatrixOfTheAdjointAction) {
  Random random(2);
  const Vector6d V = random.vector(6);
  const Vector6d W = random.vector(6);
  EXPECT_LT(relative_gap(cross_twist(V, W), twist_cross_matrix(V) * W), 1e-15);
  EXPECT_LT(testing::largest(cross_twist(V, V)), 1e-16);
}

TEST(CrossTwist, SatisfiesTheJacobiIdentity) {
  Random random(3);
  const Vector6d a = random.vector(6);
  const Vector6d b = random.vector(6);
  const Vector6d c = random.vector(6);
  const Vector6d sum = cross_twist<double>(a, cross_twist(b, c)) +
                       cross_twist<double>(b, cross_twist(c, a)) +
                       cross_twist<double>(c, cross_twist(a, b));
  EXPECT_LT(testing::largest(sum), 1e-15);
}

TEST(CrossTwist, CommutesWithAChangeOfFrame) {
  Random random(4);
  const Matrix6d Ad = adjoint(pose(random));
  const Vector6d V = random.vector(6);
  const Vector6d W = random.vector(6);
  EXPECT_LT(relative_gap(Ad * cross_twist(V, W), cross_twist<double>(Ad * V, Ad * W)), 1e-14);
}

TEST(CrossWrench, IsMinusTheTransposeOfCrossTwist) {
  Random random(5);
  const Vector6d V = random.vector(6);
  const Vector6d F = random.vector(6);
  EXPECT_LT(relative_gap(cross_wrench(V, F), -twist_cross_matrix(V).transpose() * F), 1e-15);
}

TEST(Skew, IsTheMatrixOfTheCrossProduct) {
  Random random(6);
  const Eigen::Vector3d v = random.vector3();
  const Eigen::Vector3d w = random.vector3();
  EXPECT_LT(relative_gap(skew(v) * w, v.cross(w)), 1e-15);
}

TEST(FrameTwists, AreTheAdjointOfUnitTwists) {
  Random random(7);
  const RigidTransform<double> X = pose(random);
  const Eigen::Vector3d axis = random.vector3();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_LT(relative_gap(rotation_twist(X, axis), adjoint(X) * spatial<double>(axis, zero)), 1e-15);
  EXPECT_LT(relative_gap(translation_twist(X.R, axis), adjoint(X) * spatial<double>(zero, axis)),
            1e-15);
}

}  // namespace
}  // namespace hbar
