#include "hbar/adjoint/derivatives/linearization.h"

#include <memory>

#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/adjoint/trajectory/check_trajectory.h"
#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/core/base/stop_flag.h"
#include "hbar/core/model/drives.h"
#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using solvers::SparseMatrix;

/// Entry of `stage` in a stencil; null if there is none.
template <typename Weight>
const StencilEntry<Weight>* find_entry(const FlatStencil<Weight>& stencil, int stage) {
  for (const StencilEntry<Weight>& entry : stencil.entries) {
    if (entry.stage == stage) {
      return &entry;
    }
  }
  return nullptr;
}

}  // namespace

struct Linearizer::Workspace {
  explicit Workspace(const Horizon& h)
      : horizon(h),
        history(h.model()),
        stage(h.model()),
        point(h.model()),
        pattern(residual_pattern(h.model())) {
    const int n = h.model().dof();
    for (Eigen::MatrixXd* matrix : {&G_q, &G_v, &cM, &block}) {
      matrix->setZero(n, n);
    }
    g.setZero(n);
    columns.setZero(n, h.parameters().size());
    for (const ParameterBlock& b : h.parameters().blocks()) {
      rows_of_block.push_back(parameter_rows(h.model(), b));
    }
  }

  void lay_out(const Timeline& timeline);
  void lay_out_parameters(int stages);
  void lay_out_controls(const Timeline& timeline);
  void fill_stage(const Trajectory& trajectory, int s);
  void fill_block(int s, const FlatStencil<double>& plain,
                  const std::vector<std::pair<int, FlatStencil<Matrix3d>>>& switched, int j);
  void fill_qdot0(const FlatStencil<double>& plain,
                  const std::vector<std::pair<int, FlatStencil<Matrix3d>>>& switched);
  void fill_parameters(const Trajectory& trajectory, int s);
  void fill_controls(const Trajectory& trajectory, int s);

  Horizon horizon;
  History history;
  StageResidual<double> stage;
  StagePoint<double> point;
  std::vector<std::vector<int>> pattern;
  std::vector<std::vector<int>> rows_of_block;  // per parameter block
  Linearization out;
  Timeline timeline;                     // for which the patterns were laid out
  std::vector<std::size_t> first_block;  // of H, per stage
  std::vector<std::size_t> first_q0;     // of dg_dq0 (and dg_dqdot0), per stage
  int pattern_count = 0;
  Eigen::MatrixXd G_q, G_v, cM, block, columns;
  Eigen::VectorXd g;
};

void Linearizer::Workspace::lay_out(const Timeline& t) {
  const int stages = t.stage_count() - 1;
  std::vector<std::pair<int, int>> blocks;
  std::vector<std::pair<int, int>> initial;
  first_block.assign(static_cast<std::size_t>(stages) + 2, 0);
  first_q0.assign(static_cast<std::size_t>(stages) + 2, 0);
  for (int s = 1; s <= stages; ++s) {
    const auto k = static_cast<std::size_t>(s);
    first_block[k] = blocks.size();
    first_q0[k] = initial.size();
    for (const auto& entry : flat_stencil(t, s).entries) {
      if (entry.stage == 0) {
        initial.emplace_back(s - 1, 0);
      } else {
        blocks.emplace_back(s - 1, entry.stage - 1);
      }
    }
    first_block[k + 1] = blocks.size();
    first_q0[k + 1] = initial.size();
  }
  out.H = BlockMatrix(stages, stages, blocks, pattern);
  out.dg_dq0 = BlockMatrix(stages, 1, initial, pattern);
  out.dg_dqdot0 = BlockMatrix(stages, 1, initial, pattern);
  out.block_sizes.assign(static_cast<std::size_t>(stages), horizon.model().dof());
  lay_out_parameters(stages);
  lay_out_controls(t);
  timeline = t;
  ++pattern_count;
}

void Linearizer::Workspace::lay_out_parameters(int stages) {
  const int n = horizon.model().dof();
  const ParameterSet& set = horizon.parameters();
  Eigen::VectorXi counts(set.size());
  std::vector<std::size_t> block_of(static_cast<std::size_t>(set.size()));
  for (std::size_t b = 0; b < set.blocks().size(); ++b) {
    for (int i = set.blocks()[b].first; i < set.blocks()[b].first + set.blocks()[b].size; ++i) {
      counts[i] = stages * static_cast<int>(rows_of_block[b].size());
      block_of[static_cast<std::size_t>(i)] = b;
    }
  }
  out.dg_dp = zeros_with_pattern(stages * n, counts, [&](int i, int* rows) {
    for (int s = 0; s < stages; ++s) {
      for (const int l : rows_of_block[block_of[static_cast<std::size_t>(i)]]) {
        *rows++ = s * n + l;
      }
    }
  });
}

void Linearizer::Workspace::lay_out_controls(const Timeline& t) {
  const Model& model = horizon.model();
  const int n = model.dof();
  const int controls = model.control_count();
  std::vector<int> row(static_cast<std::size_t>(controls));
  for_each_drive(model, [&](int c, int control) { row[static_cast<std::size_t>(control)] = c; });
  Eigen::VectorXi counts(controls * t.step_count());
  for (int k = 0; k < t.step_count(); ++k) {
    counts.segment(k * controls, controls).setConstant(t.step_end(k + 1) - t.step_end(k));
  }
  out.dg_du = zeros_with_pattern((t.stage_count() - 1) * n, counts, [&](int column, int* rows) {
    const int k = column / controls;
    for (int s = t.step_end(k) + 1; s <= t.step_end(k + 1); ++s) {
      *rows++ = (s - 1) * n + row[static_cast<std::size_t>(column % controls)];
    }
  });
}

/// H(s, j) = δ_sj G_q + G_v w^q̇ + c M w^a − c ∂τ/∂start · w^start.
void Linearizer::Workspace::fill_block(
    int s, const FlatStencil<double>& plain,
    const std::vector<std::pair<int, FlatStencil<Matrix3d>>>& switched, int j) {
  const JointForces<double>& forces = stage.joint_forces();
  const double c = stage.c();
  const StencilEntry<double>& w = *find_entry(plain, j);
  block = w.qdot * G_v + w.a * cM;
  block.diagonal() -= c * (w.start_q * forces.by_start_q + w.start_qdot * forces.by_start_qdot);
  for (const auto& [node, stencil] : switched) {
    const int first = horizon.model().tree().node(node).coordinates.begin;
    const StencilEntry<Matrix3d>& W = *find_entry(stencil, j);
    block.middleCols<3>(first) = G_v.middleCols<3>(first) * W.qdot + cM.middleCols<3>(first) * W.a;
    block.block<3, 3>(first, first) -=
        c * (forces.by_start_q.segment<3>(first).asDiagonal() * W.start_q +
             forces.by_start_qdot.segment<3>(first).asDiagonal() * W.start_qdot);
  }
  if (j == s) {
    block += G_q;
  }
}

void Linearizer::Workspace::fill_qdot0(
    const FlatStencil<double>& plain,
    const std::vector<std::pair<int, FlatStencil<Matrix3d>>>& switched) {
  const JointForces<double>& forces = stage.joint_forces();
  const double c = stage.c();
  block = plain.a_by_qdot0 * cM;
  block.diagonal() -= (c * plain.start_qdot_by_qdot0) * forces.by_start_qdot;
  for (const auto& [node, stencil] : switched) {
    const int first = horizon.model().tree().node(node).coordinates.begin;
    block.middleCols<3>(first) = cM.middleCols<3>(first) * stencil.a_by_qdot0;
    block.block<3, 3>(first, first) -=
        c * (forces.by_start_qdot.segment<3>(first).asDiagonal() * stencil.start_qdot_by_qdot0);
  }
}

void Linearizer::Workspace::fill_parameters(const Trajectory& trajectory, int s) {
  const ParameterSet& set = horizon.parameters();
  parameter_columns<double>({*trajectory.mechanism, set, trajectory.inputs.p}, stage, point,
                            columns);
  for (std::size_t b = 0; b < set.blocks().size(); ++b) {
    const ParameterBlock& owner = set.blocks()[b];
    const auto count = static_cast<int>(rows_of_block[b].size());
    for (int i = owner.first; i < owner.first + owner.size; ++i) {
      double* value = out.dg_dp.valuePtr() + out.dg_dp.outerIndexPtr()[i] + (s - 1) * count;
      for (const int l : rows_of_block[b]) {
        *value++ = columns(l, i);
      }
    }
  }
}

void Linearizer::Workspace::fill_controls(const Trajectory& trajectory, int s) {
  const int controls = horizon.model().control_count();
  const int step = trajectory.timeline.stage(s).step;
  const int rank = s - 1 - trajectory.timeline.step_end(step);
  for (int i = 0; i < controls; ++i) {
    out.dg_du.valuePtr()[out.dg_du.outerIndexPtr()[step * controls + i] + rank] =
        -stage.c() * stage.joint_forces().by_u[i];
  }
}

void Linearizer::Workspace::fill_stage(const Trajectory& trajectory, int s) {
  history.set_point(trajectory, s, point);
  stage.linearize(*trajectory.mechanism, point, g);
  stage.jacobian({1.0, 0.0, 0.0}, G_q);
  stage.jacobian({0.0, 1.0, 0.0}, G_v);
  stage.jacobian({0.0, 0.0, 1.0}, cM);
  const FlatStencil<double> plain = flat_stencil(timeline, s);
  std::vector<std::pair<int, FlatStencil<Matrix3d>>> switched;
  for (const int node : nodes_with_chart_switch(trajectory, s)) {
    switched.emplace_back(node, flat_stencil(horizon.model(), trajectory, s, node));
  }
  std::size_t index = first_block[static_cast<std::size_t>(s)];
  for (const StencilEntry<double>& entry : plain.entries) {
    fill_block(s, plain, switched, entry.stage);
    if (entry.stage == 0) {
      out.dg_dq0.set_block(first_q0[static_cast<std::size_t>(s)], block);
      fill_qdot0(plain, switched);
      out.dg_dqdot0.set_block(first_q0[static_cast<std::size_t>(s)], block);
    } else {
      out.H.set_block(index++, block);
    }
  }
  fill_parameters(trajectory, s);
  fill_controls(trajectory, s);
}

Linearizer::Linearizer(const Horizon& horizon)
    : work_("Linearizer", std::make_unique<Workspace>(horizon)) {}
Linearizer::~Linearizer() = default;
Linearizer::Linearizer(Linearizer&&) noexcept = default;
Linearizer& Linearizer::operator=(Linearizer&&) noexcept = default;

int Linearizer::pattern_count() const { return work_->pattern_count; }

const Linearization& Linearizer::linearize(const Trajectory& trajectory) {
  Workspace& w = *work_;
  require_whole_trajectory_of(w.horizon, trajectory);
  if (w.pattern_count == 0 || !(w.timeline == trajectory.timeline)) {
    w.lay_out(trajectory.timeline);
  }
  for (int s = 1; s < trajectory.timeline.stage_count(); ++s) {
    require_running(w.horizon.options().stop, "linearisation interrupted at stage ", s, " of ",
                    trajectory.timeline.last_stage());
    w.fill_stage(trajectory, s);
  }
  return w.out;
}

}  // namespace hbar
