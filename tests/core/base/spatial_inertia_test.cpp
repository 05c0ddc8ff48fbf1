#include "hbar/core/base/spatial_inertia.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/spatial_matrices.h"

namespace hbar {
namespace {

using testing::adjoint;
using testing::inertia_matrix;
using testing::Matrix6d;
using testing::Random;
using testing::relative_gap;
using testing::twist_cross_matrix;
using Vector6d = Vector6<double>;

/// A body somewhere in a frame A, and its inertia there as hbar has it and as a matrix.
struct Sample {
  explicit Sample(Random& random) : X_AB{random.rotation(), random.vector3()} {
    inertia = body_inertia<double>(mass, moments, X_AB);
    matrix = inertia_matrix(mass, moments, X_AB);
  }

  double mass = 1.7;
  Eigen::Vector3d moments{0.3, 0.5, 0.4};
  RigidTransform<double> X_AB;
  SpatialInertia<double> inertia;
  Matrix6d matrix;
};

/// The matrix of a linear map on 6-vectors.
template <typename Map>
Matrix6d matrix_of(const Map& map) {
  Matrix6d m;
  for (int i = 0; i < 6; ++i) {
    m.col(i) = map(Vector6d(Vector6d::Unit(i)));
  }
  return m;
}

TEST(BodyInertia, IsThePrincipalInertiaMovedByTheTransformationLaw) {
  Random random(1);
  const Sample body(random);
  EXPECT_LT(
      relative_gap(matrix_of([&](const Vector6d& V) { return body.inertia * V; }), body.matrix),
      1e-14);
}

TEST(SpatialInertia, SumsAsMatricesDo) {
  Random random(2);
  const Sample a(random);
  const Sample b(random);
  SpatialInertia<double> sum = a.inertia;
  sum += b.inertia;
  EXPECT_LT(
      relative_gap(matrix_of([&](const Vector6d& V) { return sum * V; }), a.matrix + b.matrix),
      1e-14);
}

TEST(Transformed, IsTheInertiaOfTheBodySeenFromTheOtherFrame) {
  Random random(3);
  const Sample body(random);
  const RigidTransform<double> X_CA{random.rotation(), random.vector3(3.0)};
  const SpatialInertia<double> seen = transformed(X_CA, body.inertia);
  const SpatialInertia<double> direct =
      body_inertia<double>(body.mass, body.moments, X_CA * body.X_AB);
  EXPECT_EQ(seen.mass, direct.mass);
  EXPECT_LT(relative_gap(seen.first, direct.first), 1e-15);
  EXPECT_LT(relative_gap(seen.second, direct.second), 1e-14);
}

TEST(CoriolisOperator, IsTheOperatorOfItsDefinition) {
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    const Sample body(random);
    const Vector6d V = random.vector(6, 2.0);
    const Matrix6d& I = body.matrix;
    // B W = −I (V × W) + W ×* (I V) + V ×* (I W).
    const Matrix6d defined = -I * twist_cross_matrix(V) - twist_cross_matrix(V).transpose() * I +
                             matrix_of([&](const Vector6d& W) {
                               return Vector6d(-twist_cross_matrix(W).transpose() * I * V);
                             });
    const auto B = coriolis_operator<double>(body.inertia, V, body.inertia * V);
    const Matrix6d direct = matrix_of([&](const Vector6d& W) { return B * W; });
    EXPECT_LT(relative_gap(direct, defined), 1e-14);
    const Matrix6d transposed = matrix_of([&](const Vector6d& W) {
      return spatial<double>(B.transposed_times(W), Eigen::Vector3d::Zero());
    });
    EXPECT_LT(relative_gap(transposed, defined.transpose()), 1e-14);
  }
}

TEST(CoriolisOperator, SumsOverBodies) {
  Random random(5);
  const Sample a(random);
  const Sample b(random);
  const Vector6d V = random.vector(6);
  const Vector6d W = random.vector(6);
  const auto B_a = coriolis_operator<double>(a.inertia, V, a.inertia * V);
  const auto B_b = coriolis_operator<double>(b.inertia, V, b.inertia * V);
  CoriolisOperator<double> sum = B_a;
  sum += B_b;
  EXPECT_LT(relative_gap(sum * W, B_a * W + B_b * W), 1e-15);
}

}  // namespace
}  // namespace hbar
