#include "hbar/adjoint/history.h"

#include <algorithm>

#include "hbar/core/chart.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Calls f(first coordinate) for each node whose chart differs between the two stages.
template <typename F>
void for_each_switched(const Model& model, const Trajectory& trajectory, int earlier, int stage,
                       const F& f) {
  const std::vector<ChartSwitch>& all = trajectory.chart_switches;
  for (std::size_t i = all.size(); i-- > 0 && all[i].stage >= earlier;) {
    if (all[i].stage >= stage) {
      continue;
    }
    const auto same = [&](const ChartSwitch& s) {
      return s.node == all[i].node && s.stage >= earlier && s.stage < stage;
    };
    const auto begin = all.begin();
    const bool is_last = std::none_of(begin + static_cast<std::ptrdiff_t>(i) + 1, all.end(), same);
    if (is_last && std::count_if(begin, all.end(), same) % 2 == 1) {
      f(model.tree().node(all[i].node).coordinates.begin, all[i].node);
    }
  }
}

}  // namespace

int Trajectory::newton_iterations(int k) const {
  int sum = 0;
  for (int s = timeline.step_end(k) + 1; s <= timeline.step_end(k + 1); ++s) {
    sum += newton[static_cast<std::size_t>(s)].iterations;
  }
  return sum;
}

void History::switched_nodes(const Trajectory& trajectory, int earlier, int stage,
                             std::vector<int>& nodes) const {
  nodes.clear();
  for_each_switched(model_, trajectory, earlier, stage,
                    [&](int, int node) { nodes.push_back(node); });
}

void History::gather(const Trajectory& trajectory, int stage, Eigen::VectorXd& qdot_past,
                     Eigen::VectorXd& a_past, StepStart<double>& start) const {
  const Stage& row = trajectory.timeline.stage(stage);
  qdot_past.setZero();
  a_past.setZero();
  for (int i = 0; i < row.history_size; ++i) {
    const auto [j, weight] = row.history[static_cast<std::size_t>(i)];
    qdot_past += weight * trajectory.q.col(j);
    a_past += weight * trajectory.qdot.col(j);
    for_each_switched(model_, trajectory, j, stage, [&, j = j, weight = weight](int c, int) {
      const Vector3d r = trajectory.q.col(j).segment<3>(c);
      const Vector3d rate = trajectory.qdot.col(j).segment<3>(c);
      qdot_past.segment<3>(c) += weight * (change_chart(r) - r);
      a_past.segment<3>(c) += weight * (chart_derivative(r) * rate - rate);
    });
  }
  start.q = trajectory.q.col(row.start);
  start.qdot = trajectory.qdot.col(row.start);
  for_each_switched(model_, trajectory, row.start, stage, [&](int c, int) {
    const Vector3d r = start.q.segment<3>(c);
    start.q.segment<3>(c) = change_chart(r);
    start.qdot.segment<3>(c) = chart_derivative(r) * start.qdot.segment<3>(c).eval();
  });
}

void History::scatter(const Trajectory& trajectory, int stage, const Eigen::VectorXd& y_qdot,
                      const Eigen::VectorXd& y_a, const StepStart<double>& y_start,
                      Eigen::MatrixXd& q_bar, Eigen::MatrixXd& qdot_bar) const {
  const Stage& row = trajectory.timeline.stage(stage);
  // Weights (y_position, y_rate) on a state seen from this stage become weights on the state
  // itself: identity, corrected for nodes that changed chart.
  const auto pass_back = [&](int j, double weight, const Eigen::VectorXd& y_position,
                             const Eigen::VectorXd& y_rate) {
    q_bar.col(j) += weight * y_position;
    qdot_bar.col(j) += weight * y_rate;
    for_each_switched(model_, trajectory, j, stage, [&](int c, int) {
      const Vector3d r = trajectory.q.col(j).segment<3>(c);
      const Vector3d rate = trajectory.qdot.col(j).segment<3>(c);
      const Matrix3d D = chart_derivative(r);
      const Vector3d y_r = y_position.segment<3>(c);
      const Vector3d y_v = y_rate.segment<3>(c);
      q_bar.col(j).segment<3>(c) +=
          weight * (D.transpose() * y_r - y_r + chart_second_derivative(r, rate).transpose() * y_v);
      qdot_bar.col(j).segment<3>(c) += weight * (D.transpose() * y_v - y_v);
    });
  };
  for (int i = 0; i < row.history_size; ++i) {
    const auto [j, weight] = row.history[static_cast<std::size_t>(i)];
    pass_back(j, weight, y_qdot, y_a);
  }
  pass_back(row.start, 1.0, y_start.q, y_start.qdot);
}

}  // namespace hbar
