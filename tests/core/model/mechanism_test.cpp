#include "hbar/core/model/mechanism.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/spatial_matrices.h"

namespace hbar {
namespace {

using testing::relative_gap;

void expect_inertia(const Mechanism<double>& mechanism, std::size_t link) {
  const auto k = static_cast<Eigen::Index>(link);
  const testing::Matrix6d expected =
      testing::inertia_matrix(mechanism.mass[k], mechanism.moments.col(k), mechanism.X_JB[link]);
  for (int c = 0; c < 6; ++c) {
    const Vector6<double> V = Vector6<double>::Unit(c);
    EXPECT_LT(relative_gap(mechanism.inertia[link] * V, expected.col(c)), 1e-14);
  }
}

TEST(NominalMechanism, HoldsTheModelsOwnNumbers) {
  const Model model = testing::random_model(1);
  const auto mechanism = nominal_mechanism<double>(model);
  EXPECT_EQ(mechanism.gravity, model.gravity());
  for (std::size_t i = 0; i < model.links().size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Link& link = model.links()[i];
    EXPECT_TRUE(mechanism.X_PJ[i] == link.joint.X_PJ);
    EXPECT_TRUE(mechanism.X_JB[i] == link.body.X_JB);
    EXPECT_EQ(mechanism.mass[k], link.body.mass);
    EXPECT_EQ(mechanism.moments.col(k), link.body.inertia);
    EXPECT_EQ(mechanism.stiffness[k], link.joint.stiffness);
    EXPECT_EQ(mechanism.damping[k], link.joint.damping);
    expect_inertia(mechanism, i);
  }
  for (std::size_t m = 0; m < model.motors().size(); ++m) {
    EXPECT_EQ(mechanism.motor_P[static_cast<Eigen::Index>(m)], model.motors()[m].P);
    EXPECT_EQ(mechanism.motor_D[static_cast<Eigen::Index>(m)], model.motors()[m].D);
  }
}

TEST(NominalMechanism, IsConstantOnDuals) {
  const Model model = testing::random_model(2);
  const auto mechanism = nominal_mechanism<double>(model);
  const auto dual = nominal_mechanism<Dual>(model);
  EXPECT_EQ(testing::values(dual.mass), mechanism.mass);
  EXPECT_EQ(testing::slopes(dual.mass).norm(), 0.0);
  for (std::size_t i = 0; i < dual.inertia.size(); ++i) {
    EXPECT_EQ(testing::slopes(dual.inertia[i].second).norm(), 0.0);
    EXPECT_LT(relative_gap(testing::values(dual.inertia[i].second), mechanism.inertia[i].second),
              1e-15);
  }
}

TEST(Mechanism, UpdatesItsInertiasFromMassMomentsAndPlacement) {
  const Model model = testing::random_model(3);
  auto mechanism = nominal_mechanism<double>(model);
  testing::Random random(1);
  mechanism.mass[2] *= 1.5;
  mechanism.moments.col(3) *= 0.7;
  mechanism.X_JB[4] = testing::random_pose(random);
  mechanism.update_derived(model);
  for (std::size_t i = 0; i < mechanism.inertia.size(); ++i) {
    expect_inertia(mechanism, i);
  }
}

}  // namespace
}  // namespace hbar
