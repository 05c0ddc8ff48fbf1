#include <gtest/gtest.h>

#include "hbar/core/dynamics/dynamics.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

constexpr double kGravity = 9.81;

/// Thin enough for a point mass: its moments are 1e-15 of what moves it.
Body point_mass(const std::string& name, double mass, const Eigen::Vector3d& position) {
  Body body;
  body.name = name;
  body.X_JB.p = position;
  body.mass = mass;
  body.inertia.setConstant(1e-15);
  return body;
}

ModelBuilder falling() {
  ModelBuilder builder("closed form");
  builder.set_gravity({0.0, 0.0, -kGravity});
  return builder;
}

VectorXd id_at(const Model& model, const VectorXd& q, const VectorXd& qdot, const VectorXd& a) {
  return testing::inverse_dynamics_at<double>(model, nominal_mechanism<double>(model), q, qdot, a);
}

TEST(Pendulum, HasItsEquationOfMotion) {
  const double m = 1.3;
  const double l = 0.7;
  ModelBuilder builder = falling();
  // About −y an angle turns the hanging bob towards +x.
  builder.add_link(-1, {.name = "hinge", .kind = RevoluteJoint{{0.0, -1.0, 0.0}}},
                   point_mass("bob", m, {0.0, 0.0, -l}));
  const Model model = builder.build();
  Random random(1);
  for (int k = 0; k < 10; ++k) {
    const VectorXd x = random.vector(3, 3.0);
    const double expected = m * l * l * x[2] + m * kGravity * l * std::sin(x[0]);
    EXPECT_NEAR(id_at(model, x.segment(0, 1), x.segment(1, 1), x.segment(2, 1))[0], expected,
                1e-13);
  }
}

TEST(DoublePendulum, HasItsEquationsOfMotion) {
  const double m1 = 1.3;
  const double m2 = 0.4;
  const double l1 = 0.7;
  const double l2 = 1.1;
  ModelBuilder builder = falling();
  const RevoluteJoint hinge{{0.0, -1.0, 0.0}};
  builder.add_link(-1, {.name = "first", .kind = hinge}, point_mass("m1", m1, {0.0, 0.0, -l1}));
  Joint second{.name = "second", .kind = hinge};
  second.X_PJ.p = {0.0, 0.0, -l1};
  builder.add_link(0, second, point_mass("m2", m2, {0.0, 0.0, -l2}));
  const Model model = builder.build();
  Random random(2);
  for (int k = 0; k < 10; ++k) {
    const VectorXd q = random.vector(2, 3.0);
    const VectorXd v = random.vector(2, 3.0);
    const VectorXd a = random.vector(2, 3.0);
    // Textbook form in absolute angles, then by relative ones: τ1 = Q1 + Q2, τ2 = Q2.
    const double b = q[0] + q[1];
    const double vb = v[0] + v[1];
    const double ab = a[0] + a[1];
    const double c = m2 * l1 * l2 * std::cos(q[0] - b);
    const double s = m2 * l1 * l2 * std::sin(q[0] - b);
    const double Q1 = (m1 + m2) * l1 * l1 * a[0] + c * ab + s * vb * vb +
                      (m1 + m2) * kGravity * l1 * std::sin(q[0]);
    const double Q2 =
        m2 * l2 * l2 * ab + c * a[0] - s * v[0] * v[0] + m2 * kGravity * l2 * std::sin(b);
    EXPECT_LT(relative_gap(id_at(model, q, v, a), Eigen::Vector2d(Q1 + Q2, Q2)), 1e-13);
  }
}

TEST(CartPole, HasItsEquationsOfMotion) {
  const double cart = 2.0;
  const double m = 0.5;
  const double l = 0.8;
  ModelBuilder builder = falling();
  builder.add_link(-1, {.name = "rail", .kind = PrismaticJoint{{1.0, 0.0, 0.0}}},
                   point_mass("cart", cart, {0.0, 0.0, 0.0}));
  builder.add_link(0, {.name = "hinge", .kind = RevoluteJoint{{0.0, -1.0, 0.0}}},
                   point_mass("bob", m, {0.0, 0.0, -l}));
  const Model model = builder.build();
  Random random(3);
  for (int k = 0; k < 10; ++k) {
    const VectorXd q = random.vector(2, 3.0);
    const VectorXd v = random.vector(2, 3.0);
    const VectorXd a = random.vector(2, 3.0);
    const double s = std::sin(q[1]);
    const double c = std::cos(q[1]);
    const Eigen::Vector2d expected((cart + m) * a[0] + m * l * (c * a[1] - s * v[1] * v[1]),
                                   m * l * c * a[0] + m * l * l * a[1] + m * kGravity * l * s);
    EXPECT_LT(relative_gap(id_at(model, q, v, a), expected), 1e-13);
  }
}

class EveryFreeBody : public ::testing::TestWithParam<JointKind> {};

TEST_P(EveryFreeBody, ObeysNewtonAndEuler) {
  const double m = 1.7;
  const Eigen::Vector3d I(0.3, 0.5, 0.4);
  ModelBuilder builder = falling();
  Body body;
  body.name = "body";
  body.mass = m;
  body.inertia = I;
  builder.add_link(-1, {.name = "free", .kind = GetParam()}, body);
  const Model model = builder.build();
  Random random(4);
  for (int k = 0; k < 10; ++k) {
    const VectorXd q = random.vector(6, 1.2);
    const VectorXd v = random.vector(6);
    const VectorXd a = random.vector(6);
    Motion<Dual> motion(model.tree());
    compute_motion<Dual>(model.tree(), nominal_mechanism<Dual>(model), testing::with_slope(q, v),
                         testing::with_slope(v, a), VectorX<Dual>(a.cast<Dual>()), motion);
    const NodeMotion<Dual>& node = motion.at(model.node_of_link(0));
    // Body rates and their time derivative, then Euler's equations in the body frame.
    const Vector3<Dual> w = node.R.transpose() * node.V.head<3>();
    const Eigen::Vector3d rate = testing::values(w);
    const Eigen::Vector3d torque =
        I.cwiseProduct(testing::slopes(w)) + rate.cross(Eigen::Vector3d(I.cwiseProduct(rate)));
    const Eigen::Vector3d force = m * (a.head<3>() + Eigen::Vector3d(0.0, 0.0, kGravity));
    // Generalised torque: body torque times ∂(body rate)/∂q̇.
    VectorXd expected(6);
    expected.head<3>() = force;
    for (int c = 3; c < 6; ++c) {
      const Eigen::Vector3d axis =
          testing::values(node.R).transpose() * testing::values(motion.J.col(c)).head<3>();
      expected[c] = axis.dot(torque);
    }
    EXPECT_LT(relative_gap(id_at(model, q, v, a), expected), 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Charts, EveryFreeBody,
                         ::testing::Values(JointKind(Free3dEulerJoint{}),
                                           JointKind(Free3dExpJoint{})));

}  // namespace
}  // namespace hbar
