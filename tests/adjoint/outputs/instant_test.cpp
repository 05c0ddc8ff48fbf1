#include "hbar/adjoint/outputs/instant.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;

class EveryModelsInstant : public ::testing::TestWithParam<unsigned> {
 protected:
  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  testing::Random random{GetParam()};
  const testing::State state = testing::random_state(model, random);
  const VectorXd p = testing::random_parameters(set, random);
  const VectorXd u = random.vector(model.control_count(), 0.9);
  Mechanism<double> mechanism = [this] {
    auto out = nominal_mechanism<double>(model);
    apply_parameters<double>(model, set, p, out);
    return out;
  }();
  const Applied<double> applied{mechanism, set, p};
};

TEST_P(EveryModelsInstant, HasThePosesTwistsAndContactsOfItsState) {
  InstantMotion<double> instants(model, true);
  const Instant<double> at = instants.at(applied, state.q, state.qdot, u);
  Motion<double> motion(model.tree());
  compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  for (int i = 0; i < model.tree().node_count(); ++i) {
    EXPECT_EQ(at.motion.at(i).R, motion.at(i).R);
    EXPECT_EQ(at.motion.at(i).p, motion.at(i).p);
    EXPECT_EQ(at.motion.at(i).V, motion.at(i).V);
  }
  ContactForces<double> contacts(model);
  contacts.linearize(mechanism, motion);
  ASSERT_NE(at.contacts, nullptr);
  ASSERT_EQ(at.contacts->active().size(), contacts.active().size());
  EXPECT_GT(contacts.active().size(), 0U);
  for (std::size_t i = 0; i < contacts.active().size(); ++i) {
    EXPECT_EQ(at.contacts->active()[i].wrenches.on_a, contacts.active()[i].wrenches.on_a);
    EXPECT_EQ(at.contacts->active()[i].stiffness.K_a, contacts.active()[i].stiffness.K_a);
  }
  EXPECT_EQ(at.q, state.q);
  EXPECT_EQ(at.qdot, state.qdot);
  EXPECT_EQ(at.u, u);
  EXPECT_EQ(&at.applied, &applied);
}

TEST_P(EveryModelsInstant, LeavesContactOutWhereNobodyReadsIt) {
  InstantMotion<double> instants(model, false);
  EXPECT_EQ(instants.at(applied, state.q, state.qdot, u).contacts, nullptr);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsInstant, ::testing::Values(1U, 2U));

}  // namespace
}  // namespace hbar
