#include "hbar/adjoint/systems/periodic_matrix.h"

#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using solvers::SparseMatrix;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// ∂q_N/∂q̄ and ∂q̇_N/∂q̄, with the last stage in place of stage 0.
struct EndDerivatives {
  SparseMatrix q;     // [dof x m]
  SparseMatrix qdot;  // [dof x m]
};

EndDerivatives end_derivatives(const Model& model, const Trajectory& trajectory) {
  const int n = model.dof();
  const int last = trajectory.timeline.last_stage();
  const auto column = [&](int stage, int c) { return ((stage == 0 ? last : stage) - 1) * n + c; };
  std::vector<char> is_switched(static_cast<std::size_t>(n), 0);
  Triplets q;
  Triplets qdot;
  for (const int node : nodes_with_chart_switch(trajectory, last)) {
    const int first = model.tree().node(node).coordinates.begin;
    for (const auto& entry : flat_stencil(model, trajectory, last, node).entries) {
      for (int i = 0; i < 3; ++i) {
        is_switched[static_cast<std::size_t>(first + i)] = 1;
        for (int j = 0; j < 3; ++j) {
          qdot.emplace_back(first + i, column(entry.stage, first + j), entry.qdot(i, j));
        }
      }
    }
  }
  const FlatStencil<double> plain = flat_stencil(trajectory.timeline, last);
  for (int c = 0; c < n; ++c) {
    q.emplace_back(c, column(last, c), 1.0);
    for (const auto& entry : plain.entries) {
      if (is_switched[static_cast<std::size_t>(c)] == 0) {
        qdot.emplace_back(c, column(entry.stage, c), entry.qdot);
      }
    }
  }
  EndDerivatives out{SparseMatrix(n, last * n), SparseMatrix(n, last * n)};
  out.q.setFromTriplets(q.begin(), q.end());
  out.qdot.setFromTriplets(qdot.begin(), qdot.end());
  return out;
}

}  // namespace

void refuse_changed_charts(const Model& model, const Trajectory& trajectory) {
  std::vector<int> nodes;
  History(model).switched_nodes(trajectory, 0, trajectory.timeline.last_stage(), nodes);
  if (!nodes.empty()) {
    const int coordinate = model.tree().node(nodes.front()).coordinates.begin;
    throw InvalidInput(concat("periodic: coordinate ", model.coordinate_name(coordinate),
                              " of an exponential joint ends in another chart than it starts (it "
                              "turned by more than 1.5 pi): such a motion cannot be closed; start "
                              "from less rotation"));
  }
}

SparseMatrix periodic_matrix(const Model& model, const Trajectory& trajectory,
                             const Linearization& linearization) {
  refuse_changed_charts(model, trajectory);
  const EndDerivatives end = end_derivatives(model, trajectory);
  const SparseMatrix by_q = linearization.dg_dq0.matrix() * end.q;
  const SparseMatrix by_qdot = linearization.dg_dqdot0.matrix() * end.qdot;
  const SparseMatrix corner = by_q + by_qdot;
  return linearization.H.matrix() + corner;
}

solvers::SolverOptions periodic_options(const Linearization& linearization) {
  return {.structure = solvers::Structure::kPeriodic, .block_sizes = linearization.block_sizes};
}

}  // namespace hbar
