#include "hbar/adjoint/outputs/end_effectors.h"

#include <gtest/gtest.h>

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
  void move_to(const VectorXd& at, const VectorXd& values) {
    apply_parameters<double>(model, set, values, mechanism);
    const VectorXd zero = VectorXd::Zero(model.dof());
    compute_motion<double>(model.tree(), mechanism, at, zero, zero, motion);
  }
  VectorXd positions(const VectorXd& at, const VectorXd& values) {
    move_to(at, values);
    VectorXd v = VectorXd::Zero(model.variable_count());
    effectors.positions(motion, v);
    return v;
  }

  const Model model = testing::random_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  VectorXd q = testing::random_state(model, random).q;
  VectorXd p = testing::random_parameters(set, random);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion{model.tree()};
  EndEffectors<double> effectors{model};
};

TEST_P(EveryModelsEndEffectors, AreFixedInTheirJointFrames) {
  const VectorXd v = positions(q, p);
  ASSERT_EQ(v.size(), 12);
  for (std::size_t i = 0; i < model.end_effectors().size(); ++i) {
    const EndEffector& point = model.end_effectors()[i];
    const NodeMotion<double>& joint = motion.at(model.node_of_link(point.link));
    const Eigen::Vector3d expected = joint.p + joint.R * point.position;
    EXPECT_LT(relative_gap(v.segment<3>(3 * static_cast<Eigen::Index>(i)), expected), 1e-15);
  }
}

TEST_P(EveryModelsEndEffectors, HaveTheJacobianThatDifferencesGive) {
  move_to(q, p);
  MatrixXd dv_dq = MatrixXd::Constant(model.variable_count(), model.dof(), 7.0);
  effectors.jacobian(motion, dv_dq);
  const MatrixXd expected =
      testing::differences([&](const VectorXd& x) { return positions(x, p); }, q);
  EXPECT_LT(relative_gap(dv_dq, expected), 1e-10);
}

TEST_P(EveryModelsEndEffectors, PullBackByTheTransposesOfBothDerivatives) {
  const MatrixXd by_p = testing::differences([&](const VectorXd& x) { return positions(q, x); }, p);
  move_to(q, p);
  MatrixXd dv_dq = MatrixXd::Zero(model.variable_count(), model.dof());
  effectors.jacobian(motion, dv_dq);
  for (int k = 0; k < 3; ++k) {
    const VectorXd y = random.vector(model.variable_count());
    const VectorXd q_before = random.vector(model.dof());
    const VectorXd p_before = random.vector(set.size());
    VectorXd grad_q = q_before;
    VectorXd grad_p = p_before;
    effectors.pull_back(mechanism, set, p, motion, y, grad_q, grad_p);
    EXPECT_LT(relative_gap(grad_q, q_before + dv_dq.transpose() * y), 1e-14);
    EXPECT_LT(relative_gap(grad_p, p_before + by_p.transpose() * y), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsEndEffectors, ::testing::Values(1U, 2U, 3U));

TEST(EndEffectors, AreNoneOfAModelWithoutAny) {
  ModelBuilder builder("bare");
  builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{}}, solid_body("b", Sphere{1.0}, 1.0));
  const Model model = builder.build();
  Motion<double> motion(model.tree());
  const EndEffectors<double> effectors(model);
  VectorXd v(0);
  effectors.positions(motion, v);
  EXPECT_EQ(model.variable_count(), 0);
}

}  // namespace
}  // namespace hbar
