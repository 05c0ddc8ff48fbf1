#include "hbar/adjoint/programs/input_variables.h"

#include <gtest/gtest.h>

#include <utility>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using testing::kInfinity;
using testing::message_of;
using testing::Random;

/// Seven steps in blocks of three, the last of one; two hinges, a motor on the second.
TrajectoryProblem held_problem(bool free_state) {
  ModelBuilder builder = testing::double_pendulum_builder();
  builder.add_motor({.link = 1, .kind = Motor::Kind::kForce});
  const Model model = builder.build();
  const ParameterSet set =
      ParameterSet::named(model, {"body.lower.mass", "body.lower.inertia", "joint.elbow.damping"});
  TrajectoryProblem out{.horizon = Horizon(model, set, testing::options_of("bdf1", 0.02, 7)),
                        .map = inertia_chart(set),
                        .objective = {},
                        .constraints = {},
                        .controls = {},
                        .q0 = Eigen::Vector2d(0.1, 0.2),
                        .qdot0 = Eigen::Vector2d(0.3, 0.4),
                        .design_weight = 0.7};
  out.controls.hold = 3;
  if (free_state) {
    out.initial = InitialStateBounds{};
    out.initial->q_lower = Eigen::Vector2d(-1.0, -2.0);
    out.initial->qdot_upper = Eigen::Vector2d(3.0, 4.0);
    out.q_scale = Eigen::Vector2d(0.5, 0.25);
  }
  return out;
}

/// d/dε of inputs at x along dx, a linear map but for the design map, which is linear here, too.
Inputs inputs_along(const InputVariables& head, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& dx) {
  const Inputs at = head.inputs(x);
  const Inputs moved = head.inputs(x + dx);
  return {moved.p - at.p, moved.u - at.u, moved.q0 - at.q0, moved.qdot0 - at.qdot0};
}

TEST(InputVariables, StandInTheirOrder) {
  const TrajectoryProblem problem = held_problem(true);
  const InputVariables head(problem);
  EXPECT_EQ(head.design_count(), 5);
  EXPECT_EQ(head.control_count(), 1);
  EXPECT_EQ(head.block_count(), 3);
  EXPECT_EQ(head.block_of_step(2), 0);
  EXPECT_EQ(head.block_of_step(3), 1);
  EXPECT_EQ(head.block_of_step(6), 2);
  EXPECT_EQ(head.control_place(0), 5);
  EXPECT_EQ(head.control_place(2), 7);
  EXPECT_EQ(head.state_place(), 8);
  ASSERT_EQ(head.size(), 12);
  const solvers::NlpVariables& variables = head.variables();
  const std::vector<std::string> tail(variables.names.begin() + 5, variables.names.end());
  EXPECT_EQ(tail, (std::vector<std::string>{
                      "control.elbow from step 0", "control.elbow from step 3",
                      "control.elbow from step 6", "initial shoulder", "initial elbow",
                      "initial shoulder rate", "initial elbow rate"}));
  Eigen::VectorXd tail_start(7);
  tail_start << 0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.4;
  EXPECT_EQ(variables.start.tail(7), tail_start);
  EXPECT_EQ(variables.lower.tail(4), Eigen::Vector4d(-1.0, -2.0, -kInfinity, -kInfinity));
  EXPECT_EQ(variables.upper.tail(4), Eigen::Vector4d(kInfinity, kInfinity, 3.0, 4.0));
  EXPECT_EQ(variables.scale.tail(4), Eigen::Vector4d(0.5, 0.25, 1.0, 1.0));
}

TEST(InputVariables, OfAGivenStateEndWithTheControls) {
  const TrajectoryProblem problem = held_problem(false);
  const InputVariables head(problem);
  EXPECT_FALSE(head.state_is_free());
  EXPECT_EQ(head.size(), 8);
  const Inputs inputs = head.inputs(Random(1).vector(8) + head.variables().start);
  EXPECT_EQ(inputs.q0, problem.q0);
  EXPECT_EQ(inputs.qdot0, problem.qdot0);
}

TEST(InputVariables, BoundControlsAllAlikeOrBlockByBlock) {
  TrajectoryProblem problem = held_problem(false);
  problem.controls.lower = Eigen::VectorXd::Constant(1, -2.0);
  problem.controls.upper = Eigen::Vector3d(1.0, 2.0, 3.0);
  problem.controls.scale = Eigen::VectorXd::Constant(1, 0.1);
  problem.controls.start = Eigen::MatrixXd::Constant(1, 1, 0.5);
  const InputVariables head(problem);
  EXPECT_EQ(head.variables().lower.tail(3), Eigen::Vector3d::Constant(-2.0));
  EXPECT_EQ(head.variables().upper.tail(3), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(head.variables().scale.tail(3), Eigen::Vector3d::Constant(0.1));
  EXPECT_EQ(head.variables().start.tail(3), Eigen::Vector3d::Constant(0.5));
}

TEST(InputVariables, ReadTheVariablesThatAParameterFollows) {
  const TrajectoryProblem problem = held_problem(false);
  const InputVariables head(problem);
  const Eigen::MatrixXd jacobian = problem.map->jacobian(head.variables().start.head(5));
  for (Eigen::Index p = 0; p < jacobian.rows(); ++p) {
    std::vector<Eigen::Index> expected;
    for (Eigen::Index d = 0; d < jacobian.cols(); ++d) {
      if (jacobian(p, d) != 0.0) {
        expected.push_back(d);
      }
    }
    EXPECT_EQ(head.designs_of(p), expected) << p;
  }
}

TEST(InputVariables, ArePulledBackByTheTranspose) {
  for (const bool free_state : {false, true}) {
    const TrajectoryProblem problem = held_problem(free_state);
    const InputVariables head(problem);
    Random random(4);
    const Eigen::VectorXd x = head.variables().start;
    const Eigen::VectorXd dx = random.vector(head.size(), 0.1);
    const Inputs moved = inputs_along(head, x, dx);
    const Gradient gradient{0.0, random.vector(5), random.matrix(1, 7), random.vector(2),
                            random.vector(2)};
    const Eigen::VectorXd before = random.vector(head.size() + 3);  // more variables may follow
    Eigen::VectorXd out = before;
    head.add_pull_back(gradient, problem.map->jacobian(head.design(x)), out);
    const double expected = gradient.p.dot(moved.p) + gradient.u.cwiseProduct(moved.u).sum() +
                            gradient.q0.dot(moved.q0) + gradient.qdot0.dot(moved.qdot0);
    EXPECT_NEAR((out - before).head(head.size()).dot(dx), expected, 1e-14);
    EXPECT_EQ((out - before).tail(3), Eigen::Vector3d::Zero());
  }
}

TEST(InputVariables, CostWhatTheDesignIsOffItsStart) {
  const TrajectoryProblem problem = held_problem(false);
  const InputVariables head(problem);
  const Eigen::VectorXd start = head.variables().start;
  EXPECT_EQ(head.design_cost(start), 0.0);
  Eigen::VectorXd x = start;
  x[0] += 2.0 * head.variables().scale[0];
  x[6] += 1.0;  // a control costs nothing here
  EXPECT_NEAR(head.design_cost(x), 0.5 * 0.7 * 4.0, 1e-14);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
  head.add_design_cost_gradient(x, gradient);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(x.size());
  expected[0] = 0.7 * 2.0 / head.variables().scale[0];
  EXPECT_LT(testing::relative_gap(gradient, expected), 1e-14);
  EXPECT_NEAR(head.design_cost_curvature(0), expected[0] / (x[0] - start[0]),
              1e-13 * head.design_cost_curvature(0));
}

TEST(InputVariables, RefusePartsThatDoNotFit) {
  const auto message = [](const auto& spoil) {
    TrajectoryProblem problem = held_problem(true);
    spoil(problem);
    return message_of<InvalidInput>([&] { static_cast<void>(InputVariables(problem)); });
  };
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.map = nullptr; }),
            "TrajectoryProblem: there is no map from designs to parameters (it is empty or null)");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.controls.hold = 0; }),
            "TrajectoryProblem: controls.hold is 0; it must be ≥ 1");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.design_weight = testing::kNan; }),
            "TrajectoryProblem: design_weight is nan; it must be ≥ 0");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.controls.start.setZero(1, 2); }),
            "TrajectoryProblem: controls.start is 1 x 2; it must be 1 x 3 or 1 x 1");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.controls.upper.setZero(2); }),
            "TrajectoryProblem: controls.upper has 2 entries; it must have 1");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.q0.setZero(3); }),
            "TrajectoryProblem: q0 has 3 entries; it must have 2");
  EXPECT_EQ(message([](TrajectoryProblem& parts) { parts.initial->q_upper.setZero(1); }),
            "TrajectoryProblem: initial.q_upper has 1 entries; it must have 2");
}

TEST(InputVariables, RefuseAVectorThatIsTooShort) {
  const TrajectoryProblem problem = held_problem(true);
  const InputVariables head(problem);
  EXPECT_EQ(
      message_of<InvalidInput>([&] { static_cast<void>(head.inputs(Eigen::VectorXd::Zero(11))); }),
      "TrajectoryProblem: x has 11 entries; it must have 12");
}

TEST(InputVariables, RefuseTermsThatReadBeyondTheTrajectory) {
  const TrajectoryProblem problem = held_problem(false);
  const InputVariables head(problem);
  const auto reading = [](ValueField field, int index, int step) {
    return value_limits("row", field, index, {step}, 0.0, 1.0);
  };
  EXPECT_NO_THROW(head.require_places(*reading(ValueField::kQ, 1, 7)));
  EXPECT_NO_THROW(head.require_places(*reading(ValueField::kP, 4, 0)));
  EXPECT_EQ(message_of<InvalidInput>([&] { head.require_places(*reading(ValueField::kU, 0, 7)); }),
            "constraint 'row at step 7' reads u 0 at step 7; there are 1 x 7 of u");
  EXPECT_THROW(head.require_places(*reading(ValueField::kQ, 2, 0)), InvalidInput);
  EXPECT_THROW(
      head.require_places(*reading(ValueField::kMeasured, problem.horizon.measured_count(), 0)),
      InvalidInput);
  EXPECT_THROW(head.require_places(*reading(ValueField::kP, 5, 0)), InvalidInput);
}

}  // namespace
}  // namespace hbar
