#include "hbar/core/dynamics/motion.h"

#include <gtest/gtest.h>

#include "tests/core/model/joint_definition.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/spatial_matrices.h"

namespace hbar {
namespace {

using testing::kStates;
using testing::Random;
using testing::relative_gap;
using testing::State;
using Vector6d = Vector6<double>;

/// How every node of a model moves at a state.
Motion<double> motion_at(const Model& model, const State& state) {
  const auto mechanism = nominal_mechanism<double>(model);
  Motion<double> motion(model.tree());
  compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  return motion;
}

/// The same along q + t q̇ + t² a / 2, with rates, as duals in t at t = 0.
Motion<Dual> motion_along(const Model& model, const State& state) {
  const auto mechanism = nominal_mechanism<Dual>(model);
  Motion<Dual> motion(model.tree());
  const VectorX<Dual> a = state.a.cast<Dual>();
  compute_motion<Dual>(model.tree(), mechanism, testing::with_slope(state.q, state.qdot),
                       testing::with_slope(state.qdot, state.a), a, motion);
  return motion;
}

/// World twist of a pose that moves: (ω; velocity of what is at the world's origin).
Vector6d twist_of(const NodeMotion<Dual>& node) {
  const Eigen::Matrix3d R = testing::values(node.R);
  const Eigen::Matrix3d W = testing::slopes(node.R) * R.transpose();
  const Eigen::Vector3d w(W(2, 1), W(0, 2), W(1, 0));
  const Eigen::Vector3d p = testing::values(node.p);
  return spatial<double>(w, testing::slopes(node.p) - w.cross(p));
}

class EveryModelsMotion : public ::testing::TestWithParam<unsigned> {
 protected:
  const Model model = testing::random_model(GetParam());
  Random random{GetParam()};
};

TEST_P(EveryModelsMotion, HasTheLinkPosesOfItsJointsDefinitions) {
  for (int k = 0; k < kStates; ++k) {
    const State state = testing::random_state(model, random);
    const Motion<double> motion = motion_at(model, state);
    std::vector<RigidTransform<double>> poses;
    for (int i = 0; i < model.link_count(); ++i) {
      const Link& link = model.link(i);
      const CoordinateRange range = model.coordinates_of_link(i);
      const testing::JointDefinition definition(
          state.q.segment(range.begin, range.end - range.begin));
      const RigidTransform<double> X_0P =
          link.parent < 0 ? RigidTransform<double>{} : poses[static_cast<std::size_t>(link.parent)];
      poses.push_back(X_0P * link.joint.X_PJ * definition.of(link.joint.kind));
      const NodeMotion<double>& node = motion.at(model.node_of_link(i));
      EXPECT_LT(relative_gap(node.R, poses.back().R), 1e-14);
      EXPECT_LT(relative_gap(node.p, poses.back().p), 1e-14);
      const RigidTransform<double> rest =
          rest_frame(model, nominal_mechanism<double>(model), motion, i);
      EXPECT_LT(relative_gap(rest.R, (X_0P * link.joint.X_PJ).R), 1e-14);
      EXPECT_LT(relative_gap(rest.p, (X_0P * link.joint.X_PJ).p), 1e-14);
      EXPECT_TRUE(model.tree().node(first_node_of_link(model, i)).first);
      EXPECT_EQ(model.tree().node(first_node_of_link(model, i)).link, i);
    }
  }
}

TEST_P(EveryModelsMotion, HasOrthonormalAxes) {
  const Motion<double> motion = motion_at(model, testing::random_state(model, random));
  for (const NodeMotion<double>& node : motion.nodes) {
    EXPECT_LT(testing::largest((node.R.transpose() * node.R - Eigen::Matrix3d::Identity()).eval()),
              1e-14);
  }
}

TEST_P(EveryModelsMotion, HasTheTwistsAndAccelerationsOfItsMovingPoses) {
  for (int k = 0; k < kStates; ++k) {
    const State state = testing::random_state(model, random);
    const Motion<double> motion = motion_at(model, state);
    const Motion<Dual> along = motion_along(model, state);
    Vector6d A_0 = Vector6d::Zero();
    A_0.tail<3>() = -model.gravity();
    for (int i = 0; i < model.tree().node_count(); ++i) {
      EXPECT_LT(relative_gap(motion.at(i).V, twist_of(along.at(i))), 1e-13) << "node " << i;
      const Vector6d V_dot = testing::slopes(along.at(i).V);
      EXPECT_LT(relative_gap(motion.at(i).A, V_dot + A_0), 1e-13) << "node " << i;
    }
  }
}

TEST_P(EveryModelsMotion, HasPosesWhoseDifferencesAreItsTwists) {
  const State state = testing::random_state(model, random);
  const Motion<double> motion = motion_at(model, state);
  for (int i = 0; i < model.tree().node_count(); ++i) {
    // The world velocity of a point fixed in the node is ω × x + ν.
    const Eigen::Vector3d point(0.3, -0.2, 0.5);
    const auto position = [&](const Eigen::VectorXd& t) -> Eigen::VectorXd {
      State moved = state;
      moved.q += t[0] * state.qdot;
      const Motion<double> there = motion_at(model, moved);
      return there.at(i).p + there.at(i).R * point;
    };
    const Eigen::Vector3d velocity = testing::differences(position, Eigen::VectorXd::Zero(1));
    const Eigen::Vector3d x = position(Eigen::VectorXd::Zero(1));
    const Vector6d& V = motion.at(i).V;
    const Eigen::Vector3d expected = V.tail<3>() + V.head<3>().cross(x);
    EXPECT_LT((velocity - expected).norm(), 1e-9 * (1.0 + expected.norm())) << "node " << i;
  }
}

TEST_P(EveryModelsMotion, HasAColumnOfJForTheTwistOfEachRate) {
  const State state = testing::random_state(model, random);
  const Motion<double> motion = motion_at(model, state);
  for (int i = 0; i < model.tree().node_count(); ++i) {
    Vector6d V = Vector6d::Zero();
    for (int c = 0; c < model.dof(); ++c) {
      if (model.tree().is_on_path(model.tree().node_of(c), i)) {
        V += motion.J.col(c) * state.qdot[c];
      }
    }
    EXPECT_LT((motion.at(i).V - V).norm(), 1e-13 * (1.0 + V.norm())) << "node " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsMotion, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
