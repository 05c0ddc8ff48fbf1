#include "hbar/adjoint/trajectory/history.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/chart.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::relative_gap;

/// What gather computes.
struct Gathered {
  explicit Gathered(const Model& model)
      : qdot_past(VectorXd::Zero(model.dof())),
        a_past(VectorXd::Zero(model.dof())),
        start{VectorXd::Zero(model.dof()), VectorXd::Zero(model.dof())} {}

  [[nodiscard]] VectorXd flat() const {
    VectorXd out(4 * a_past.size());
    out << qdot_past, a_past, start.q, start.qdot;
    return out;
  }

  VectorXd qdot_past;
  VectorXd a_past;
  StepStart<double> start;
};

/// A made-up trajectory whose three exponential joints change chart now and then.
struct Scene {
  explicit Scene(std::string_view integrator) : model(testing::random_model(4)), history(model) {
    testing::Random random(9);
    for (int k = 0; k < 6; ++k) {
      trajectory.timeline.append(find_integrator(integrator), k, 0.1);
      trajectory.timeline.end_step();
    }
    const int stages = trajectory.timeline.stage_count();
    trajectory.q = 2.0 * random.matrix(model.dof(), stages);
    trajectory.qdot = random.matrix(model.dof(), stages);
    for (int i = 0; i < model.tree().node_count(); ++i) {
      if (model.tree().node(i).motion == MotionKind::kExponential) {
        exponential.push_back(i);
      }
    }
    trajectory.chart_switches = {{1, exponential.at(0)}, {2, exponential.at(1)},
                                 {3, exponential.at(0)}, {3, exponential.at(2)},
                                 {4, exponential.at(1)}, {5, exponential.at(1)}};
  }

  [[nodiscard]] Gathered gather(const Trajectory& at, int stage) const {
    Gathered out(model);
    history.gather(at, stage, out.qdot_past, out.a_past, out.start);
    return out;
  }

  /// A change of stage j's state, as it is seen from a later stage.
  void pass(int j, int stage, VectorXd& dq, VectorXd& dqdot) const {
    std::vector<int> nodes;
    history.switched_nodes(trajectory, j, stage, nodes);
    for (const int node : nodes) {
      const int c = model.tree().node(node).coordinates.begin;
      const Eigen::Vector3d r = trajectory.q.col(j).segment<3>(c);
      const Eigen::Vector3d rate = trajectory.qdot.col(j).segment<3>(c);
      const Eigen::Vector3d dr = dq.segment<3>(c);
      const Eigen::Vector3d drate = dqdot.segment<3>(c);
      dq.segment<3>(c) = chart_derivative(r) * dr;
      dqdot.segment<3>(c) = chart_derivative(r) * drate + chart_second_derivative(r, rate) * dr;
    }
  }

  /// The derivative of gather along a change of all states.
  [[nodiscard]] Gathered derivative(int stage, const MatrixXd& dq, const MatrixXd& dqdot) const {
    const Stage& row = trajectory.timeline.stage(stage);
    Gathered out(model);
    for (int i = 0; i < row.history_size; ++i) {
      const StageWeight& past = row.history[static_cast<std::size_t>(i)];
      VectorXd dq_j = dq.col(past.stage);
      VectorXd dqdot_j = dqdot.col(past.stage);
      pass(past.stage, stage, dq_j, dqdot_j);
      out.qdot_past += past.weight * dq_j;
      out.a_past += past.weight * dqdot_j;
    }
    out.start = {dq.col(row.start), dqdot.col(row.start)};
    pass(row.start, stage, out.start.q, out.start.qdot);
    return out;
  }

  Model model;
  History history;
  Trajectory trajectory;
  std::vector<int> exponential;
};

TEST(History, SwitchedNodesAreThoseThatSwitchedAnOddNumberOfTimesInBetween) {
  const Scene scene("bdf1");
  const std::vector<int>& e = scene.exponential;
  const auto switched = [&](int earlier, int stage) {
    std::vector<int> nodes;
    scene.history.switched_nodes(scene.trajectory, earlier, stage, nodes);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  };
  using Nodes = std::vector<int>;
  EXPECT_EQ(switched(0, 1), Nodes{});
  EXPECT_EQ(switched(1, 2), Nodes{e[0]});
  EXPECT_EQ(switched(2, 3), Nodes{e[1]});
  EXPECT_EQ(switched(1, 3), (Nodes{e[0], e[1]}));
  EXPECT_EQ(switched(3, 4), (Nodes{e[0], e[2]}));
  EXPECT_EQ(switched(1, 4), (Nodes{e[1], e[2]}));  // e[0] is back where it was
  EXPECT_EQ(switched(2, 6), (Nodes{e[0], e[1], e[2]}));
}

TEST(History, GathersWeightedStatesInTheChartOfTheStage) {
  const Scene scene("bdf2");
  const Trajectory& trajectory = scene.trajectory;
  const int stage = 5;
  const Stage& row = trajectory.timeline.stage(stage);
  ASSERT_EQ(row.history_size, 2);
  const Gathered gathered = scene.gather(trajectory, stage);
  // The joint that never switched between stages 3 and 5, and one that did at 3.
  const int c = scene.model.tree().node(scene.exponential[2]).coordinates.begin;
  VectorXd expected = VectorXd::Zero(scene.model.dof());
  for (const StageWeight& past : {row.history[0], row.history[1]}) {
    expected += past.weight * trajectory.q.col(past.stage);
  }
  const StageWeight& old = row.history[1];
  ASSERT_EQ(old.stage, 3);
  const Eigen::Vector3d r = trajectory.q.col(3).segment<3>(c);
  expected.segment<3>(c) += old.weight * (change_chart(r) - r);
  EXPECT_LT((gathered.qdot_past - expected).segment(c, 3).norm(), 1e-13 * expected.norm());
}

TEST(History, SetRatesFollowsTheRow) {
  const Scene scene("bdf1");
  StagePoint<double> point(scene.model);
  testing::Random random(1);
  point.q = random.vector(scene.model.dof());
  point.rate = 4.0;
  const VectorXd qdot_past = random.vector(scene.model.dof());
  const VectorXd a_past = random.vector(scene.model.dof());
  History::set_rates(qdot_past, a_past, point);
  EXPECT_EQ(point.qdot, VectorXd(4.0 * point.q + qdot_past));
  EXPECT_EQ(point.a, VectorXd(4.0 * point.qdot + a_past));
}

class HistoryOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(HistoryOfEveryIntegrator, DerivativeOfGatherIsThatOfItsChartMaps) {
  const Scene scene(GetParam());
  testing::Random random(2);
  const int stages = scene.trajectory.timeline.stage_count();
  const MatrixXd dq = random.matrix(scene.model.dof(), stages);
  const MatrixXd dqdot = random.matrix(scene.model.dof(), stages);
  for (int stage = 1; stage < stages; ++stage) {
    const auto along = [&](const VectorXd& e) {
      Trajectory moved = scene.trajectory;
      moved.q += e[0] * dq;
      moved.qdot += e[0] * dqdot;
      return scene.gather(moved, stage).flat();
    };
    const MatrixXd expected = testing::differences(along, VectorXd::Zero(1));
    EXPECT_LT(relative_gap(scene.derivative(stage, dq, dqdot).flat(), expected.col(0)), 1e-8)
        << stage;
  }
}

TEST_P(HistoryOfEveryIntegrator, ScatterIsTheTransposeOfTheDerivativeOfGather) {
  const Scene scene(GetParam());
  testing::Random random(3);
  const int n = scene.model.dof();
  const int stages = scene.trajectory.timeline.stage_count();
  for (int stage = 1; stage < stages; ++stage) {
    const MatrixXd dq = random.matrix(n, stages);
    const MatrixXd dqdot = random.matrix(n, stages);
    const VectorXd y_qdot = random.vector(n);
    const VectorXd y_a = random.vector(n);
    const StepStart<double> y_start{random.vector(n), random.vector(n)};
    MatrixXd q_bar = MatrixXd::Zero(n, stages);
    MatrixXd qdot_bar = MatrixXd::Zero(n, stages);
    scene.history.scatter(scene.trajectory, stage, y_qdot, y_a, y_start, q_bar, qdot_bar);
    const Gathered moved = scene.derivative(stage, dq, dqdot);
    const double forward = y_qdot.dot(moved.qdot_past) + y_a.dot(moved.a_past) +
                           y_start.q.dot(moved.start.q) + y_start.qdot.dot(moved.start.qdot);
    const double backward = q_bar.cwiseProduct(dq).sum() + qdot_bar.cwiseProduct(dqdot).sum();
    const double scale = q_bar.norm() * dq.norm() + qdot_bar.norm() * dqdot.norm();
    EXPECT_LT(std::abs(forward - backward), 1e-13 * scale) << stage;
  }
}

TEST_P(HistoryOfEveryIntegrator, ScatterAddsToWhatIsThere) {
  const Scene scene(GetParam());
  const int n = scene.model.dof();
  const int stages = scene.trajectory.timeline.stage_count();
  const VectorXd y = VectorXd::Ones(n);
  MatrixXd once_q = MatrixXd::Zero(n, stages);
  MatrixXd once_qdot = MatrixXd::Zero(n, stages);
  MatrixXd added_q = MatrixXd::Ones(n, stages);
  MatrixXd added_qdot = MatrixXd::Ones(n, stages);
  scene.history.scatter(scene.trajectory, 3, y, y, {y, y}, once_q, once_qdot);
  scene.history.scatter(scene.trajectory, 3, y, y, {y, y}, added_q, added_qdot);
  EXPECT_LT(relative_gap((added_q.array() - 1.0).matrix(), once_q), 1e-14);
  EXPECT_LT(relative_gap((added_qdot.array() - 1.0).matrix(), once_qdot), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, HistoryOfEveryIntegrator, ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

TEST(History, SetsAPointThatSolvesItsStage) {
  const Model model = testing::random_model(32);
  testing::Random random(2);
  for (const Integrator& integrator : integrators()) {
    const Horizon horizon =
        testing::make_horizon(model, testing::options_of(integrator.name, 0.01, 3));
    Inputs inputs = horizon.nominal_inputs();
    inputs.q0 = random.vector(model.dof(), 0.3);
    const Trajectory trajectory = simulate(horizon, inputs).trajectory();
    StagePoint<double> point(model);
    StageResidual<double> residual(model);
    History history(model);
    const auto mechanism = nominal_mechanism<double>(model);
    Eigen::VectorXd g(model.dof());
    for (int s = 1; s < trajectory.timeline.stage_count(); ++s) {
      history.set_point(trajectory, s, point);
      residual.residual(mechanism, point, g);
      EXPECT_LT(g.norm(), horizon.options().newton.tol) << integrator.name << ' ' << s;
      EXPECT_EQ(point.q, trajectory.q.col(s));
      EXPECT_EQ(point.qdot, trajectory.qdot.col(s));
    }
  }
}

}  // namespace
}  // namespace hbar
