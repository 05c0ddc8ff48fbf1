#include "hbar/core/dynamics/dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/spatial_matrices.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;
using testing::State;

/// Kinetic energy ½ q̇ᵀ M q̇ as a sum over bodies of ½ m v² + ½ ω·Iω, from poses alone.
Dual kinetic_energy(const Model& model, const State& state, const VectorXd& dq,
                    const VectorXd& dqdot) {
  const auto mechanism = nominal_mechanism<Dual>(model);
  Motion<Dual> motion(model.tree());
  const VectorX<Dual> zero = VectorX<Dual>::Zero(model.dof());
  compute_motion<Dual>(model.tree(), mechanism, testing::with_slope(state.q, dq),
                       testing::with_slope(state.qdot, dqdot), zero, motion);
  Dual energy = 0.0;
  for (int i = 0; i < model.link_count(); ++i) {
    const Body& body = model.link(i).body;
    const NodeMotion<Dual>& node = motion.at(model.node_of_link(i));
    const Matrix3<Dual> R_0B = node.R * body.X_JB.R.cast<Dual>();
    const Vector3<Dual> x = node.p + node.R * body.X_JB.p.cast<Dual>();
    const Vector3<Dual> w = node.V.head<3>();
    const Vector3<Dual> v = node.V.tail<3>() + w.cross(x);
    const Vector3<Dual> w_B = R_0B.transpose() * w;
    energy += 0.5 * body.mass * v.dot(v) +
              0.5 * w_B.dot(body.inertia.cast<Dual>().cwiseProduct(w_B).eval());
  }
  return energy;
}

double potential_energy(const Model& model, const VectorXd& q) {
  const auto mechanism = nominal_mechanism<double>(model);
  Motion<double> motion(model.tree());
  const VectorXd zero = VectorXd::Zero(model.dof());
  compute_motion<double>(model.tree(), mechanism, q, zero, zero, motion);
  double energy = 0.0;
  for (int i = 0; i < model.link_count(); ++i) {
    const Body& body = model.link(i).body;
    const NodeMotion<double>& node = motion.at(model.node_of_link(i));
    energy -= body.mass * model.gravity().dot(node.p + node.R * body.X_JB.p);
  }
  return energy;
}

VectorXd id_at(const Model& model, const State& state) {
  return testing::inverse_dynamics_at<double>(model, nominal_mechanism<double>(model), state.q,
                                              state.qdot, state.a);
}

MatrixXd mass_at(const Model& model, const VectorXd& q) {
  return testing::mass_matrix_at<double>(model, nominal_mechanism<double>(model), q);
}

class EveryModelsDynamics : public ::testing::TestWithParam<unsigned> {
 protected:
  const Model model = testing::random_model(GetParam());
  Random random{GetParam()};
};

TEST_P(EveryModelsDynamics, ObeysLagrangesEquations) {
  // τ = d/dt ∂T/∂q̇ − ∂T/∂q + ∂U/∂q, with ∂T by duals and the rest by differences of those.
  const State state = testing::random_state(model, random);
  const VectorXd zero = VectorXd::Zero(model.dof());
  const auto gradient = [&](const State& at, bool by_rate) {
    VectorXd out(model.dof());
    for (int i = 0; i < model.dof(); ++i) {
      const VectorXd e = VectorXd::Unit(model.dof(), i);
      out[i] = kinetic_energy(model, at, by_rate ? zero : e, by_rate ? e : zero).slope;
    }
    return out;
  };
  const VectorXd momentum_rate = testing::differences(
      [&](const VectorXd& t) -> VectorXd {
        return gradient({state.q + t[0] * state.qdot, state.qdot + t[0] * state.a, state.a}, true);
      },
      VectorXd::Zero(1));
  const VectorXd by_height = testing::differences(
                                 [&](const VectorXd& q) -> VectorXd {
                                   return VectorXd::Constant(1, potential_energy(model, q));
                                 },
                                 state.q)
                                 .transpose();
  const VectorXd expected = momentum_rate - gradient(state, false) + by_height;
  EXPECT_LT(relative_gap(id_at(model, state), expected), 1e-9);
}

TEST_P(EveryModelsDynamics, HasAPositiveDefiniteMassMatrixWhoseFormIsTheKineticEnergy) {
  for (int k = 0; k < 20; ++k) {
    const State state = testing::random_state(model, random);
    const MatrixXd M = mass_at(model, state.q);
    EXPECT_EQ(M, M.transpose());
    EXPECT_EQ(M.llt().info(), Eigen::Success);
    const VectorXd zero = VectorXd::Zero(model.dof());
    const double energy = kinetic_energy(model, state, zero, zero).value;
    EXPECT_NEAR(0.5 * state.qdot.dot(M * state.qdot), energy, 1e-13 * energy);
  }
}

TEST_P(EveryModelsDynamics, IsAffineInItsAccelerationsWithTheMassMatrix) {
  const State state = testing::random_state(model, random);
  State still = state;
  still.a.setZero();
  const VectorXd difference = id_at(model, state) - id_at(model, still);
  EXPECT_LT(relative_gap(difference, mass_at(model, state.q) * state.a), 1e-12);
}

TEST_P(EveryModelsDynamics, BalancesPower) {
  const State state = testing::random_state(model, random);
  const VectorXd zero = VectorXd::Zero(model.dof());
  const double kinetic = kinetic_energy(model, state, state.qdot, state.a).slope;
  const double potential = testing::differences(
      [&](const VectorXd& t) -> VectorXd {
        return VectorXd::Constant(1, potential_energy(model, state.q + t[0] * state.qdot));
      },
      VectorXd::Zero(1))(0, 0);
  const double power = id_at(model, state).dot(state.qdot);
  EXPECT_NEAR(power, kinetic + potential, 1e-10 * std::abs(power) + 1e-8);
}

TEST_P(EveryModelsDynamics, GivesTheSameForcesWithAndWithoutSubtreeSums) {
  const State state = testing::random_state(model, random);
  const auto mechanism = nominal_mechanism<double>(model);
  Motion<double> motion(model.tree());
  Dynamics<double> dynamics(model);
  VectorXd tau = VectorXd::Zero(model.dof());
  compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  subtree_dynamics<double>(model, mechanism, motion, dynamics, tau);
  EXPECT_LT(relative_gap(tau, id_at(model, state)), 1e-14);
  // The sums of a root are those over all bodies of its tree, as matrices.
  testing::Matrix6d expected = testing::Matrix6d::Zero();
  for (int i = 0; i < model.link_count(); ++i) {
    if (model.tree().is_on_path(0, model.node_of_link(i))) {
      const Body& body = model.link(i).body;
      const NodeMotion<double>& node = motion.at(model.node_of_link(i));
      expected += testing::inertia_matrix(body.mass, body.inertia,
                                          RigidTransform<double>{node.R, node.p} * body.X_JB);
    }
  }
  for (int c = 0; c < 6; ++c) {
    const Vector6<double> V = Vector6<double>::Unit(c);
    EXPECT_LT(relative_gap(dynamics.below(0).I * V, expected.col(c)), 1e-13);
  }
}

/// The model moved rigidly by X_0W, gravity with it.
Model moved_with_gravity(const Model& model, const RigidTransform<double>& X_0W) {
  ModelBuilder builder(model.name(), model.units());
  builder.set_gravity(X_0W.R * model.gravity());
  for (const Link& link : model.links()) {
    Joint joint = link.joint;
    if (link.parent < 0) {
      joint.X_PJ = X_0W * joint.X_PJ;
    }
    builder.add_link(link.parent, joint, link.body, link.name);
  }
  return builder.build();
}

TEST_P(EveryModelsDynamics, DoesNotDependOnTheWorldFrame) {
  const State state = testing::random_state(model, random);
  const Model other = moved_with_gravity(model, {random.rotation(), random.vector3(2.0)});
  EXPECT_LT(relative_gap(id_at(other, state), id_at(model, state)), 1e-12);
  EXPECT_LT(relative_gap(mass_at(other, state.q), mass_at(model, state.q)), 1e-12);
}

TEST_P(EveryModelsDynamics, DoesNotDependOnTheOrderOfItsLinks) {
  // A random order in which parents still come before their children.
  std::vector<int> order;
  std::vector<int> place(model.links().size(), -1);
  while (order.size() < model.links().size()) {
    const int i = static_cast<int>(random.between(0.0, model.link_count()));
    const int parent = model.link(i).parent;
    if (place[static_cast<std::size_t>(i)] < 0 &&
        (parent < 0 || place[static_cast<std::size_t>(parent)] >= 0)) {
      place[static_cast<std::size_t>(i)] = static_cast<int>(order.size());
      order.push_back(i);
    }
  }
  ModelBuilder builder(model.name());
  builder.set_gravity(model.gravity());
  std::vector<int> coordinates;
  for (const int i : order) {
    const Link& link = model.link(i);
    builder.add_link(link.parent < 0 ? -1 : place[static_cast<std::size_t>(link.parent)],
                     link.joint, link.body, link.name);
    const CoordinateRange range = model.coordinates_of_link(i);
    for (int c = range.begin; c < range.end; ++c) {
      coordinates.push_back(c);
    }
  }
  const Model other = builder.build();
  ASSERT_NE(order, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}));
  const State state = testing::random_state(model, random);
  const State permuted = {state.q(coordinates), state.qdot(coordinates), state.a(coordinates)};
  EXPECT_LT(relative_gap(id_at(other, permuted), id_at(model, state)(coordinates)), 1e-13);
  EXPECT_LT(
      relative_gap(mass_at(other, permuted.q), mass_at(model, state.q)(coordinates, coordinates)),
      1e-13);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsDynamics, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
