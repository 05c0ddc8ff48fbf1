#include "hbar/adjoint/trajectory/flat_stencil.h"

#include <algorithm>

#include "hbar/core/base/chart.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How a state passes along an edge: D is its first derivative, E that of the rate with respect to
/// the coordinates.
template <typename Weight>
struct Passage {
  Weight D;
  Weight E;
};

/// Edges of coordinates that keep their chart.
struct PlainEdges {
  using Weight = double;
  [[nodiscard]] Passage<double> operator()(int, int) const { return {1.0, 0.0}; }
  [[nodiscard]] static double zero() { return 0.0; }
  [[nodiscard]] static double one() { return 1.0; }
};

/// Edges of one exponential node.
struct NodeEdges {
  using Weight = Matrix3d;
  const Trajectory& trajectory;
  int node;
  int first;  // coordinate

  [[nodiscard]] Passage<Matrix3d> operator()(int earlier, int stage) const {
    const auto between = [&](const ChartSwitch& s) {
      return s.node == node && s.stage >= earlier && s.stage < stage;
    };
    const std::vector<ChartSwitch>& all = trajectory.chart_switches;
    if (std::count_if(all.begin(), all.end(), between) % 2 == 0) {
      return {Matrix3d::Identity(), Matrix3d::Zero()};
    }
    const Vector3d r = trajectory.q.col(earlier).segment<3>(first);
    const Vector3d rate = trajectory.qdot.col(earlier).segment<3>(first);
    return {chart_derivative(r), chart_second_derivative(r, rate)};
  }
  [[nodiscard]] static Matrix3d zero() { return Matrix3d::Zero(); }
  [[nodiscard]] static Matrix3d one() { return Matrix3d::Identity(); }
};

/// Builds a flat stencil by following edges at most two deep.
template <typename Edges>
class Flattener {
 public:
  using Weight = typename Edges::Weight;

  Flattener(const Timeline& timeline, const Edges& edges) : timeline_(timeline), edges_(edges) {
    out_.a_by_qdot0 = Edges::zero();
    out_.start_qdot_by_qdot0 = Edges::zero();
  }

  FlatStencil<Weight> flatten(int stage) {
    const Stage& row = timeline_.stage(stage);
    entry(stage).qdot += row.rate * Edges::one();
    entry(stage).a += row.rate * row.rate * Edges::one();
    for (int i = 0; i < row.history_size; ++i) {
      const auto [j, weight] = row.history[static_cast<std::size_t>(i)];
      const Passage<Weight> pass = edges_(j, stage);
      entry(j).qdot += weight * pass.D;
      entry(j).a += row.rate * weight * pass.D + weight * pass.E;
      add_rate(j, weight * pass.D, &StencilEntry<Weight>::a, out_.a_by_qdot0);
    }
    const Passage<Weight> pass = edges_(row.start, stage);
    entry(row.start).start_q += pass.D;
    entry(row.start).start_qdot += pass.E;
    add_rate(row.start, pass.D, &StencilEntry<Weight>::start_qdot, out_.start_qdot_by_qdot0);
    std::sort(out_.entries.begin(), out_.entries.end(),
              [](const auto& a, const auto& b) { return a.stage < b.stage; });
    out_.reaches_start = out_.entries.front().stage == 0;
    return std::move(out_);
  }

 private:
  StencilEntry<Weight>& entry(int stage) {
    for (StencilEntry<Weight>& e : out_.entries) {
      if (e.stage == stage) {
        return e;
      }
    }
    out_.entries.push_back({stage, Edges::zero(), Edges::zero(), Edges::zero(), Edges::zero()});
    return out_.entries.back();
  }

  /// Adds factor · q̇_j, written in coordinates, to one field.
  void add_rate(int j, const Weight& factor, Weight StencilEntry<Weight>::*field,
                Weight& by_qdot0) {
    if (j == 0) {
      by_qdot0 += factor;
      entry(0);
      return;
    }
    const Stage& row = timeline_.stage(j);
    entry(j).*field += row.rate * factor;
    for (int i = 0; i < row.history_size; ++i) {
      const auto [earlier, weight] = row.history[static_cast<std::size_t>(i)];
      entry(earlier).*field += factor * (weight * edges_(earlier, j).D);
    }
  }

  const Timeline& timeline_;
  const Edges& edges_;
  FlatStencil<Weight> out_;
};

}  // namespace

FlatStencil<double> flat_stencil(const Timeline& timeline, int stage) {
  const PlainEdges edges;
  return Flattener<PlainEdges>(timeline, edges).flatten(stage);
}

FlatStencil<Matrix3d> flat_stencil(const Model& model, const Trajectory& trajectory, int stage,
                                   int node) {
  const NodeEdges edges{trajectory, node, model.tree().node(node).coordinates.begin};
  return Flattener<NodeEdges>(trajectory.timeline, edges).flatten(stage);
}

std::vector<int> nodes_with_chart_switch(const Trajectory& trajectory, int stage) {
  std::vector<int> nodes;
  if (trajectory.chart_switches.empty()) {
    return nodes;
  }
  const int reach = flat_stencil(trajectory.timeline, stage).entries.front().stage;
  for (const ChartSwitch& s : trajectory.chart_switches) {
    const bool near = s.stage >= reach && s.stage < stage;
    if (near && std::find(nodes.begin(), nodes.end(), s.node) == nodes.end()) {
      nodes.push_back(s.node);
    }
  }
  return nodes;
}

}  // namespace hbar
