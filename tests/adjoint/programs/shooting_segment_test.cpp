#include "hbar/adjoint/programs/shooting_segment.h"

#include <gtest/gtest.h>

#include <utility>

#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::Random;
using testing::relative_gap;

constexpr int kHorizon = 10;
constexpr int kBegin = 4;  // of the segment under test, within a block of controls
constexpr int kLength = 5;
constexpr int kHold = 3;

/// Steps 4 … 8 of ten, of which the sixth restarts; its blocks of controls are the second and the
/// third.
class SegmentOfEveryIntegrator : public ::testing::TestWithParam<std::string> {
 protected:
  static Problem make(const std::string& integrator) {
    Problem problem = testing::make_problem(testing::small_model(), integrator, 0.02, kHorizon);
    const Model model = problem.horizon.model();
    const ParameterSet set =
        ParameterSet::named(model, {"body.arm.mass", "joint.hinge.translation"});
    SimulationOptions options = problem.horizon.options();
    options.restarts = {kBegin, 6};
    options.measurements = {MotorPower{"power", 0}};
    problem.horizon = Horizon(model, set, options);
    problem.inputs.p = set.nominal();
    for (int k = 0; k < kHorizon; ++k) {
      problem.inputs.u.col(k) = problem.inputs.u.col(k - k % kHold);
    }
    return problem;
  }
  [[nodiscard]] SegmentColumns columns() const {
    return {.design = 2,
            .first_control = 2 + controls,
            .controls = 2 * controls,
            .first_state = 2 + 4 * controls,
            .state = 2 * dof};
  }
  /// What the segment is given: its own controls, and the whole's state where it begins.
  [[nodiscard]] Inputs inputs() const {
    return {problem.inputs.p, problem.inputs.u.middleCols(kBegin, kLength), values.q.col(kBegin),
            values.qdot.col(kBegin)};
  }
  [[nodiscard]] TrajectoryPartials random_weights(unsigned seed) const {
    Random random(seed);
    TrajectoryPartials out(segment.values());
    for (Eigen::MatrixXd* field : {&out.q, &out.qdot, &out.measured, &out.u}) {
      *field = random.matrix(field->rows(), field->cols());
    }
    out.p = random.vector(out.p.size());
    return out;
  }
  /// Inputs moved along the segment's variables.
  [[nodiscard]] Inputs moved(const Eigen::VectorXd& along, double by) const {
    Inputs out = inputs();
    out.p += by * map_jacobian * along.head(2);
    for (int k = 0; k < kLength; ++k) {
      const int block = (kBegin + k) / kHold - kBegin / kHold;
      out.u.col(k) += by * along.segment(2 + block * controls, controls);
    }
    out.q0 += by * along.tail(2 * dof).head(dof);
    out.qdot0 += by * along.tail(dof);
    return out;
  }
  /// A gradient by inputs as one by the segment's variables.
  [[nodiscard]] Eigen::VectorXd by_variables(const Gradient& gradient) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(columns().size());
    out.head(2) = map_jacobian.transpose() * gradient.p;
    for (int k = 0; k < kLength; ++k) {
      const int block = (kBegin + k) / kHold - kBegin / kHold;
      out.segment(2 + block * controls, controls) += gradient.u.col(k);
    }
    out.tail(2 * dof) << gradient.q0, gradient.qdot0;
    return out;
  }

  Problem problem = make(GetParam());
  const Eigen::Index dof = problem.horizon.model().dof();
  const Eigen::Index controls = problem.horizon.model().control_count();
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const TrajectoryValues values = read_values(problem.horizon, trajectory);
  const Eigen::MatrixXd map_jacobian = Random(1).matrix(problem.horizon.parameters().size(), 2);
  ShootingSegment segment{problem.horizon, kBegin, kLength, kHold, columns()};
};

TEST_P(SegmentOfEveryIntegrator, HasTheValuesOfTheWhole) {
  segment.simulate(inputs());
  ASSERT_EQ(segment.failure(), "");
  EXPECT_EQ(segment.first_step(), kBegin);
  EXPECT_EQ(segment.step_count(), kLength);
  EXPECT_FALSE(segment.changes_chart());
  // Newton ends at 1e-13.
  EXPECT_LT(relative_gap(segment.values().q, values.q.middleCols(kBegin, kLength + 1)), 1e-11);
  EXPECT_LT(relative_gap(segment.values().qdot, values.qdot.middleCols(kBegin, kLength + 1)),
            1e-11);
  EXPECT_LT(relative_gap(segment.values().v(), values.v().middleCols(kBegin, kLength + 1)), 1e-11);
  // The first measurement reads the control that begins to act there, all others that which ends.
  EXPECT_LT(relative_gap(segment.values().measured.rightCols(kLength),
                         values.measured.middleCols(kBegin + 1, kLength)),
            1e-11);
}

/// The whole's tangent is the segment's along what moves within it and the tangent of its start.
TEST_P(SegmentOfEveryIntegrator, HasTheTangentsOfTheWhole) {
  segment.simulate(inputs());
  const Tangents& mine = segment.differentiate(map_jacobian);
  Random random(2);
  const Eigen::Vector2d design = random.vector(2);
  const Eigen::MatrixXd blocks = random.matrix(controls, 4);
  Directions along = Directions::zero(problem.horizon, 1);
  along.p = map_jacobian * design;
  along.q0 = random.vector(dof);
  along.qdot0 = random.vector(dof);
  for (int k = 0; k < kHorizon; ++k) {
    along.u.middleRows(k * controls, controls) = blocks.col(k / kHold);
  }
  const Tangents whole = TangentSweep(problem.horizon).push_forward(trajectory, along);
  Eigen::VectorXd variables(columns().size());
  variables << design, blocks.middleCols(1, 2).reshaped(), whole.q.middleRows(kBegin * dof, dof),
      whole.qdot.middleRows(kBegin * dof, dof);
  const auto expect_same = [&](const Eigen::MatrixXd& part, const Eigen::MatrixXd& all) {
    const Eigen::Index rows = all.rows() / (kHorizon + 1);
    // Not the first column: a measurement there reads another control.
    EXPECT_LT(relative_gap(part.bottomRows(kLength * rows) * variables,
                           all.middleRows((kBegin + 1) * rows, kLength * rows)),
              1e-10);
  };
  expect_same(mine.q, whole.q);
  expect_same(mine.qdot, whole.qdot);
  expect_same(mine.measured, whole.measured);
}

TEST_P(SegmentOfEveryIntegrator, PullsBackByTheTransposeOfItsTangents) {
  segment.simulate(inputs());
  const Tangents& tangents = segment.differentiate(map_jacobian);
  TrajectoryPartials weights = random_weights(3);
  weights.u.setZero();  // inputs themselves are no tangents
  weights.p.setZero();
  const Eigen::VectorXd expected = tangents.q.transpose() * weights.q.reshaped() +
                                   tangents.qdot.transpose() * weights.qdot.reshaped() +
                                   tangents.measured.transpose() * weights.measured.reshaped();
  EXPECT_LT(relative_gap(by_variables(segment.pull_back(weights)), expected), 1e-10);
}

TEST_P(SegmentOfEveryIntegrator, BendsAsItsGradientsMove) {
  segment.simulate(inputs());
  const TrajectoryPartials weights = random_weights(4);
  Eigen::VectorXd by_p;
  const Eigen::MatrixXd curvature = segment.curvature(weights, map_jacobian, by_p);
  EXPECT_LT(relative_gap(curvature, curvature.transpose()), 1e-10);
  EXPECT_LT(relative_gap(by_p, segment.pull_back(weights).p), 1e-12);
  const Eigen::VectorXd along = Random(5).vector(columns().size(), 0.1);
  const auto gradient_at = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    segment.simulate(moved(along, e[0]));
    return by_variables(segment.pull_back(weights));
  };
  const Eigen::MatrixXd expected =
      testing::differences(gradient_at, Eigen::VectorXd::Zero(1), 1e-2);
  EXPECT_LT(relative_gap(curvature * along, expected), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(All, SegmentOfEveryIntegrator, ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& c) { return c.param; });

TEST(SegmentColumns, AreTheInverseOfTheirPlaces) {
  const std::vector<SegmentColumns> all = {
      {.design = 3, .first_control = 3, .controls = 4},  // a given state
      {.design = 3, .first_control = 3, .controls = 4, .first_state = 9, .state = 6},
      {.design = 0, .first_control = 8, .controls = 4, .first_state = 20, .state = 2},
      {.design = 2, .first_control = 2, .controls = 0, .first_state = 2, .state = 4}};
  for (const SegmentColumns& columns : all) {
    EXPECT_EQ(columns.size(), columns.design + columns.controls + columns.state);
    Eigen::Index before = -1;
    for (Eigen::Index i = 0; i < columns.size(); ++i) {
      EXPECT_EQ(columns.variable(columns.place(i)), i);
      EXPECT_GT(columns.place(i), before);
      before = columns.place(i);
    }
  }
  EXPECT_EQ(all[1].place(2), 2);
  EXPECT_EQ(all[1].place(6), 6);
  EXPECT_EQ(all[1].place(7), 9);
  EXPECT_EQ(all[2].place(0), 8);
}

TEST(ShootingSegment, SaysWhyItFailsAndGoesOn) {
  Problem problem = testing::small_problem("bdf1");
  ShootingSegment segment(problem.horizon, 0, 3, 1, {});
  Inputs inputs = problem.inputs;
  inputs.u = problem.inputs.u.leftCols(3).eval();
  Inputs impossible = inputs;
  const int mass = problem.horizon.parameters().find("body.arm.mass");
  impossible.p[mass] = -1.0;
  segment.simulate(impossible);
  EXPECT_NE(segment.failure().find("body.arm.mass"), std::string::npos);
  segment.simulate(inputs);
  EXPECT_EQ(segment.failure(), "");
  EXPECT_EQ(segment.values().q.cols(), 4);
}

TEST(ShootingSegment, TellsOfChangedCharts) {
  Problem problem = testing::spinning_problem("bdf1");
  ShootingSegment segment(problem.horizon, 0, problem.horizon.options().steps, 1, {});
  segment.simulate(problem.inputs);
  ASSERT_EQ(segment.failure(), "");
  EXPECT_TRUE(segment.changes_chart());
}

}  // namespace
}  // namespace hbar
