#include "hbar/core/dynamics/pullback.h"

#include <gtest/gtest.h>

#include "hbar/core/dynamics/columns.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::kStates;
using testing::Random;
using testing::relative_gap;
using testing::State;

class EveryModelsPullback : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Everything at a state, and the pullback of z.
  void evaluate(const State& state, const VectorXd& z) {
    compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
    subtree_dynamics<double>(model, mechanism, motion, dynamics, tau);
    (void)pullback.weigh(model, motion, dynamics, z);
    pullback.finish(model, motion, dynamics, z);
  }
  MatrixXd combined(double q, double v, double a) {
    MatrixXd out = MatrixXd::Zero(model.dof(), model.dof());
    columns.combine(model.tree(), motion, dynamics, {q, v, a}, out);
    return out;
  }

  const Model model = testing::random_model(GetParam());
  const Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Random random{GetParam()};
  Motion<double> motion{model.tree()};
  Dynamics<double> dynamics{model};
  Columns<double> columns{model.tree()};
  Pullback<double> pullback{model};
  VectorXd tau = VectorXd::Zero(model.dof());
};

TEST_P(EveryModelsPullback, PullsBackByTheTransposeOfEachDerivative) {
  for (int k = 0; k < kStates; ++k) {
    const VectorXd z = random.vector(model.dof());
    evaluate(testing::random_state(model, random), z);
    EXPECT_LT(relative_gap(pullback.by_q, combined(1.0, 0.0, 0.0).transpose() * z), 1e-13);
    EXPECT_LT(relative_gap(pullback.by_qdot, combined(0.0, 1.0, 0.0).transpose() * z), 1e-13);
    EXPECT_LT(relative_gap(pullback.by_a, combined(0.0, 0.0, 1.0).transpose() * z), 1e-13);
  }
}

TEST_P(EveryModelsPullback, PullsBackGravity) {
  const State state = testing::random_state(model, random);
  const VectorXd z = random.vector(model.dof());
  evaluate(state, z);
  auto dual = nominal_mechanism<Dual>(model);
  for (int k = 0; k < 3; ++k) {
    dual.gravity = testing::with_slope(model.gravity(), Eigen::Vector3d(Eigen::Vector3d::Unit(k)));
    const VectorX<Dual> id = testing::inverse_dynamics_at<Dual>(
        model, dual, state.q.cast<Dual>(), state.qdot.cast<Dual>(), state.a.cast<Dual>());
    const double expected = z.dot(testing::slopes(id));
    EXPECT_NEAR(pullback.by_gravity()[k], expected, 1e-12 * (1.0 + std::abs(expected)));
  }
}

TEST_P(EveryModelsPullback, GivesEachNodeTheTwistOfZ) {
  const VectorXd z = random.vector(model.dof());
  State state = testing::random_state(model, random);
  evaluate(state, z);
  std::vector<Vector6<double>> twists;
  for (int i = 0; i < model.tree().node_count(); ++i) {
    twists.push_back(pullback.twist(i));
  }
  state.qdot = z;
  evaluate(state, z);
  for (int i = 0; i < model.tree().node_count(); ++i) {
    EXPECT_LT((motion.at(i).V - twists[static_cast<std::size_t>(i)]).norm(), 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsPullback, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
