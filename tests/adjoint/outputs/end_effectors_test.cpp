// The end effectors among what is measured.
#include <gtest/gtest.h>

#include "hbar/adjoint/outputs/measurements.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

class EveryModelsEndEffectors : public ::testing::TestWithParam<unsigned> {
 protected:
  Instant<double> move_to(const VectorXd& at, const VectorXd& values) {
    apply_parameters<double>(model, set, values, mechanism);
    applied_p = values;
    return instants.at(applied, at, none, none.head(0));
  }
  VectorXd positions(const VectorXd& at, const VectorXd& values) {
    VectorXd v = VectorXd::Zero(effectors.size());
    effectors.read(move_to(at, values), v);
    return v;
  }

  const Model model = testing::random_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  VectorXd q = testing::random_state(model, random).q;
  VectorXd p = testing::random_parameters(set, random);
  VectorXd applied_p = p;
  const VectorXd none = VectorXd::Zero(model.dof());
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  const Applied<double> applied{mechanism, set, applied_p};
  Measurements<double> effectors{model, model_measurements(model)};
  InstantMotion<double> instants{model, false};
};

TEST_P(EveryModelsEndEffectors, AreFixedInTheirJointFrames) {
  const VectorXd v = positions(q, p);
  const Instant<double> at = move_to(q, p);
  ASSERT_EQ(v.size(), 12);
  ASSERT_EQ(model.variable_count(), 12);
  for (std::size_t i = 0; i < model.end_effectors().size(); ++i) {
    const EndEffector& point = model.end_effectors()[i];
    const NodeMotion<double>& joint = at.motion.at(model.node_of_link(point.link));
    const Eigen::Vector3d expected = joint.p + joint.R * point.position;
    EXPECT_LT(relative_gap(v.segment<3>(3 * static_cast<Eigen::Index>(i)), expected), 1e-15);
  }
}

TEST_P(EveryModelsEndEffectors, PullBackByTheTransposesOfBothDerivatives) {
  const MatrixXd by_q = testing::differences([&](const VectorXd& x) { return positions(x, p); }, q);
  const MatrixXd by_p = testing::differences([&](const VectorXd& x) { return positions(q, x); }, p);
  const Instant<double> at = move_to(q, p);
  for (int k = 0; k < 3; ++k) {
    const VectorXd y = random.vector(model.variable_count());
    const VectorXd q_before = random.vector(model.dof());
    const VectorXd p_before = random.vector(set.size());
    VectorXd grad_q = q_before;
    VectorXd grad_qdot = VectorXd::Zero(model.dof());
    VectorXd grad_u(0);
    VectorXd grad_p = p_before;
    InstantGradient<double> by{grad_q, grad_qdot, grad_u, grad_p};
    effectors.pull_back(at, y, by);
    EXPECT_LT(relative_gap(grad_q, q_before + by_q.transpose() * y), 1e-9);
    EXPECT_LT(relative_gap(grad_p, p_before + by_p.transpose() * y), 1e-9);
    EXPECT_EQ(grad_qdot, none);
  }
}

/// ∂v/∂q column by column from the joints' world twists.
TEST_P(EveryModelsEndEffectors, HaveTheJacobianOfTheirJointsTwists) {
  const VectorXd v = positions(q, p);
  const Instant<double> at = move_to(q, p);
  MatrixXd expected = MatrixXd::Zero(model.variable_count(), model.dof());
  for (std::size_t i = 0; i < model.end_effectors().size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const int node = model.node_of_link(model.end_effectors()[i].link);
    for (int c = 0; c < model.dof(); ++c) {
      if (model.tree().is_on_path(model.tree().node_of(c), node)) {
        const Vector6<double> J = at.motion.J.col(c);
        expected.block<3, 1>(row, c) = J.tail<3>() + J.head<3>().cross(v.segment<3>(row));
      }
    }
  }
  for (int r = 0; r < model.variable_count(); ++r) {
    VectorXd grad_q = none;
    VectorXd grad_qdot = none;
    VectorXd grad_u(0);
    VectorXd grad_p = VectorXd::Zero(set.size());
    InstantGradient<double> by{grad_q, grad_qdot, grad_u, grad_p};
    effectors.pull_back(at, VectorXd::Unit(model.variable_count(), r), by);
    EXPECT_LT(relative_gap(grad_q, expected.row(r).transpose()), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsEndEffectors, ::testing::Values(1U, 2U, 3U));

TEST(EndEffectors, AreNoneOfAModelWithoutAny) {
  ModelBuilder builder("bare");
  builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{}}, solid_body("b", Sphere{1.0}, 1.0));
  const Model model = builder.build();
  EXPECT_EQ(model.variable_count(), 0);
  EXPECT_TRUE(model_measurements(model).empty());
}

}  // namespace
}  // namespace hbar
