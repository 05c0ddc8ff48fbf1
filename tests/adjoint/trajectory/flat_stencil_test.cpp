#include "hbar/adjoint/trajectory/flat_stencil.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

/// Rates of a stage of a scalar trajectory, by its two-level definition.
struct Rates {
  double qdot = 0.0;
  double a = 0.0;
};

Rates rates_of(const Timeline& timeline, int s, const Eigen::VectorXd& q, double qdot0) {
  std::vector<double> qdot(static_cast<std::size_t>(s) + 1, qdot0);
  Rates out;
  for (int k = 1; k <= s; ++k) {
    const Stage& row = timeline.stage(k);
    double rate = row.rate * q[k];
    for (int i = 0; i < row.history_size; ++i) {
      const StageWeight& w = row.history[static_cast<std::size_t>(i)];
      rate += w.weight * q[w.stage];
    }
    out = {rate, row.rate * rate};
    for (int i = 0; i < row.history_size; ++i) {
      const StageWeight& w = row.history[static_cast<std::size_t>(i)];
      out.a += w.weight * qdot[static_cast<std::size_t>(w.stage)];
    }
    qdot[static_cast<std::size_t>(k)] = rate;
  }
  return out;
}

class FlatStencilOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(FlatStencilOfEveryIntegrator, GivesTheRatesOfTheTwoLevelDefinition) {
  Timeline timeline;
  for (int k = 0; k < 6; ++k) {
    timeline.append(find_integrator(GetParam()), k, k == 3 ? 0.05 : 0.1);
    timeline.end_step();
  }
  const Eigen::VectorXd q =
      Eigen::VectorXd::LinSpaced(timeline.stage_count(), 0.3, 2.0).array().sin();
  const double qdot0 = 0.7;
  for (int s = 1; s < timeline.stage_count(); ++s) {
    const FlatStencil<double> stencil = flat_stencil(timeline, s);
    double qdot = 0.0;
    double a = stencil.a_by_qdot0 * qdot0;
    for (const auto& entry : stencil.entries) {
      qdot += entry.qdot * q[entry.stage];
      a += entry.a * q[entry.stage];
    }
    const Rates expected = rates_of(timeline, s, q, qdot0);
    EXPECT_NEAR(qdot, expected.qdot, 1e-12 * (1.0 + std::abs(expected.qdot))) << s;
    EXPECT_NEAR(a, expected.a, 1e-11 * (1.0 + std::abs(expected.a))) << s;
    EXPECT_EQ(stencil.entries.back().stage, s);
  }
}

TEST_P(FlatStencilOfEveryIntegrator, IsTheScalarOneWhereANodeKeepsItsChart) {
  Problem problem = testing::spinning_problem(GetParam());
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  ASSERT_EQ(trajectory.chart_switches.size(), 1U);
  const ChartSwitch& change = trajectory.chart_switches.front();
  const Model& model = problem.horizon.model();
  EXPECT_TRUE(nodes_with_chart_switch(trajectory, change.stage).empty());
  EXPECT_EQ(nodes_with_chart_switch(trajectory, change.stage + 1), std::vector<int>{change.node});
  const auto plain = flat_stencil(trajectory.timeline, change.stage);
  const auto blocks = flat_stencil(model, trajectory, change.stage, change.node);
  ASSERT_EQ(plain.entries.size(), blocks.entries.size());
  for (std::size_t i = 0; i < plain.entries.size(); ++i) {
    EXPECT_EQ(blocks.entries[i].a, plain.entries[i].a * Eigen::Matrix3d::Identity());
    EXPECT_EQ(blocks.entries[i].qdot, plain.entries[i].qdot * Eigen::Matrix3d::Identity());
  }
}

TEST_P(FlatStencilOfEveryIntegrator, FollowsRatesThroughAChangeOfChart) {
  Problem problem = testing::spinning_problem(GetParam());
  const Trajectory base = simulate(problem.horizon, problem.inputs).trajectory();
  const Model& model = problem.horizon.model();
  const int node = base.chart_switches.front().node;
  const int s = base.chart_switches.front().stage + 1;
  const int first = model.tree().node(node).coordinates.begin;
  const History history(model);
  // q̇ and q̈ of stage s as a function of one earlier stage's coordinates; the rates of stages in
  // between follow, as they do in the simulation.
  const auto rates = [&](int stage, const Eigen::Vector3d& step) {
    Trajectory moved = base;
    moved.q.col(stage).segment<3>(first) += step;
    StagePoint<double> point(model);
    Eigen::VectorXd qdot_past(model.dof());
    Eigen::VectorXd a_past(model.dof());
    for (int k = std::max(stage, 1); k <= s; ++k) {
      history.gather(moved, k, qdot_past, a_past, point.start);
      point.rate = moved.timeline.stage(k).rate;
      point.q = moved.q.col(k);
      History::set_rates(qdot_past, a_past, point);
      moved.qdot.col(k) = point.qdot;
    }
    Eigen::VectorXd out(6);
    out << point.qdot.segment<3>(first), point.a.segment<3>(first);
    return out;
  };
  for (const auto& entry : flat_stencil(model, base, s, node).entries) {
    for (int i = 0; i < 3; ++i) {
      const auto difference = [&](double step) {
        const Eigen::Vector3d e = step * Eigen::Vector3d::Unit(i);
        return Eigen::VectorXd((rates(entry.stage, e) - rates(entry.stage, -e)) / (2.0 * step));
      };
      const Eigen::VectorXd expected = (4.0 * difference(1e-3) - difference(2e-3)) / 3.0;
      EXPECT_LT((entry.qdot.col(i) - expected.head<3>()).norm(), 1e-8 * entry.qdot.norm() + 1e-8);
      EXPECT_LT((entry.a.col(i) - expected.tail<3>()).norm(), 1e-8 * entry.a.norm() + 1e-8);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FlatStencilOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
