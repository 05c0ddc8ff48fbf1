#include "hbar/adjoint/trajectory/history.h"

#include <algorithm>

#include "hbar/core/base/chart.h"

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

template <Scalar S>
void History::gather(const Trajectory& trajectory, const MatrixX<S>& q, const MatrixX<S>& qdot,
                     int stage, VectorX<S>& qdot_past, VectorX<S>& a_past,
                     StepStart<S>& start) const {
  const Stage& row = trajectory.timeline.stage(stage);
  qdot_past.setZero();
  a_past.setZero();
  for (int i = 0; i < row.history_size; ++i) {
    const auto [j, weight] = row.history[static_cast<std::size_t>(i)];
    qdot_past += weight * q.col(j);
    a_past += weight * qdot.col(j);
    for_each_switched(model_, trajectory, j, stage, [&, j = j, weight = weight](int c, int) {
      const Vector3<S> r = q.col(j).template segment<3>(c);
      const Vector3<S> rate = qdot.col(j).template segment<3>(c);
      qdot_past.template segment<3>(c) += weight * (change_chart<S>(r) - r);
      a_past.template segment<3>(c) += weight * (chart_derivative<S>(r) * rate - rate);
    });
  }
  start.q = q.col(row.start);
  start.qdot = qdot.col(row.start);
  for_each_switched(model_, trajectory, row.start, stage, [&](int c, int) {
    const Vector3<S> r = start.q.template segment<3>(c);
    start.q.template segment<3>(c) = change_chart<S>(r);
    start.qdot.template segment<3>(c) =
        chart_derivative<S>(r) * start.qdot.template segment<3>(c).eval();
  });
}

void History::set_point(const Trajectory& trajectory, int stage, StagePoint<double>& point) {
  const Stage& row = trajectory.timeline.stage(stage);
  gather(trajectory, stage, qdot_past_, a_past_, point.start);
  point.rate = row.rate;
  point.u = trajectory.inputs.u.col(row.step);
  point.q = trajectory.q.col(stage);
  set_rates(qdot_past_, a_past_, point);
}

template <Scalar S>
void History::scatter(const Trajectory& trajectory, const MatrixX<S>& q, const MatrixX<S>& qdot,
                      int stage, const VectorX<S>& y_qdot, const VectorX<S>& y_a,
                      const StepStart<S>& y_start, MatrixX<S>& q_bar, MatrixX<S>& qdot_bar) const {
  const Stage& row = trajectory.timeline.stage(stage);
  // Weights (y_position, y_rate) on a state seen from this stage become weights on the state
  // itself: identity, corrected for nodes that changed chart.
  const auto pass_back = [&](int j, double weight, const VectorX<S>& y_position,
                             const VectorX<S>& y_rate) {
    q_bar.col(j) += weight * y_position;
    qdot_bar.col(j) += weight * y_rate;
    for_each_switched(model_, trajectory, j, stage, [&](int c, int) {
      const Vector3<S> r = q.col(j).template segment<3>(c);
      const Vector3<S> rate = qdot.col(j).template segment<3>(c);
      const Matrix3<S> D = chart_derivative<S>(r);
      const Vector3<S> y_r = y_position.template segment<3>(c);
      const Vector3<S> y_v = y_rate.template segment<3>(c);
      q_bar.col(j).template segment<3>(c) +=
          weight *
          (D.transpose() * y_r - y_r + chart_second_derivative<S>(r, rate).transpose() * y_v);
      qdot_bar.col(j).template segment<3>(c) += weight * (D.transpose() * y_v - y_v);
    });
  };
  for (int i = 0; i < row.history_size; ++i) {
    const auto [j, weight] = row.history[static_cast<std::size_t>(i)];
    pass_back(j, weight, y_qdot, y_a);
  }
  pass_back(row.start, 1.0, y_start.q, y_start.qdot);
}

template void History::gather(const Trajectory&, const MatrixX<double>&, const MatrixX<double>&,
                              int, VectorX<double>&, VectorX<double>&, StepStart<double>&) const;
template void History::gather(const Trajectory&, const MatrixX<Dual>&, const MatrixX<Dual>&, int,
                              VectorX<Dual>&, VectorX<Dual>&, StepStart<Dual>&) const;
template void History::scatter(const Trajectory&, const MatrixX<double>&, const MatrixX<double>&,
                               int, const VectorX<double>&, const VectorX<double>&,
                               const StepStart<double>&, MatrixX<double>&, MatrixX<double>&) const;
template void History::scatter(const Trajectory&, const MatrixX<Dual>&, const MatrixX<Dual>&, int,
                               const VectorX<Dual>&, const VectorX<Dual>&, const StepStart<Dual>&,
                               MatrixX<Dual>&, MatrixX<Dual>&) const;

}  // namespace hbar
