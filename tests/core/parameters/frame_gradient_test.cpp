#include "hbar/core/parameters/frame_gradient.h"

#include <gtest/gtest.h>

#include "hbar/core/dynamics/body_motion.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::Random;

/// The world twist of a moving frame: Ẋ X⁻¹ of a pose that carries its slope.
Vector6<double> twist_of(const RigidTransform<Dual>& X) {
  const Eigen::Matrix3d R = testing::values(X.R);
  const Eigen::Matrix3d W = testing::slopes(X.R) * R.transpose();
  const Eigen::Vector3d omega(W(2, 1), W(0, 2), W(1, 0));
  return spatial<double>(omega, testing::slopes(X.p) - omega.cross(testing::values(X.p)));
}

class EveryModelsFrames : public ::testing::TestWithParam<unsigned> {
 protected:
  /// How the frame of a block moves with parameter i, by dual numbers.
  Vector6<double> twist_by_duals(const ParameterBlock& block, int i) const {
    auto moving = nominal_mechanism<Dual>(model);
    const VectorXd along = VectorXd::Unit(p.size(), i);
    apply_parameters<Dual>(model, set, testing::with_slope(p, along), moving);
    Motion<Dual> poses(model.tree());
    const VectorX<Dual> q = state.q.cast<Dual>();
    const VectorX<Dual> zero = VectorX<Dual>::Zero(model.dof());
    compute_motion<Dual>(model.tree(), moving, q, zero, zero, poses);
    return twist_of(block.kind == ParameterKind::kJointTransform
                        ? rest_frame<Dual>(model, moving, poses, block.owner)
                        : body_motion<Dual>(model, moving, poses, block.owner).X_WB);
  }
  /// Visits every parameter of every joint and body transformation: visit(block, index).
  template <typename Visit>
  void for_each_frame_parameter(const Visit& visit) const {
    for (const ParameterBlock& block : set.blocks()) {
      if (block.kind == ParameterKind::kJointTransform ||
          block.kind == ParameterKind::kBodyTransform) {
        for (int i = block.first; i < block.first + block.size; ++i) {
          visit(block, i);
        }
      }
    }
  }

  const Model model = testing::random_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  const VectorXd p = testing::random_parameters(set, random);
  const testing::State state = testing::random_state(model, random);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion{model.tree()};

  void SetUp() override {
    apply_parameters<double>(model, set, p, mechanism);
    compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  }
};

TEST_P(EveryModelsFrames, MoveWithEachParameterByTheTwistThatDualsGive) {
  for_each_frame_parameter([&](const ParameterBlock& block, int i) {
    const auto twists = frame_twists<double>(model, {mechanism, set, p}, motion, block);
    const Vector6<double> expected = twist_by_duals(block, i);
    EXPECT_LT((twists(set[i].component) - expected).norm(), 1e-13 * (1.0 + expected.norm()))
        << set[i].name;
  });
}

TEST_P(EveryModelsFrames, TurnACovectorIntoItsPowerOnEachTwist) {
  const Vector6<double> covector = random.vector(6);
  VectorXd grad = VectorXd::Constant(set.size(), 0.5);
  for (const ParameterBlock& block : set.blocks()) {
    if (block.kind == ParameterKind::kJointTransform ||
        block.kind == ParameterKind::kBodyTransform) {
      add_frame_gradient<double>(model, {mechanism, set, p}, motion, block, covector, grad);
    }
  }
  for_each_frame_parameter([&](const ParameterBlock& block, int i) {
    const double expected = covector.dot(twist_by_duals(block, i));
    EXPECT_NEAR(grad[i], 0.5 + expected, 1e-13 * (1.0 + std::abs(expected))) << set[i].name;
  });
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsFrames, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
