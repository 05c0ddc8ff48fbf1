#include "hbar/adjoint/programs/stage_layout.h"

#include "hbar/adjoint/trajectory/flat_stencil.h"

namespace hbar {

StageLayout::StageLayout(const InputVariables& head, const Timeline& timeline, int dof)
    : dof_(dof),
      head_(head.size()),
      start_(head.state_is_free() ? head.state_place() : -1),
      runs_(static_cast<std::size_t>(timeline.stage_count())),
      steps_ended_(runs_.size(), -1),
      steps_(runs_.size(), 0) {
  for (int k = 0; k <= timeline.step_count(); ++k) {
    ends_.push_back(timeline.step_end(k));
    steps_ended_[static_cast<std::size_t>(ends_.back())] = k;
  }
  if (start_ >= 0) {
    runs_[0] = {{.place = start_, .q = 1.0}, {.place = start_ + dof, .qdot = 1.0}};
  }
  for (int s = 1; s <= timeline.last_stage(); ++s) {
    steps_[static_cast<std::size_t>(s)] = timeline.stage(s).step;
    std::vector<StageRun>& runs = runs_[static_cast<std::size_t>(s)];
    const FlatStencil<double> stencil = flat_stencil(timeline, s);
    for (const StencilEntry<double>& entry : stencil.entries) {
      if (place(entry.stage) >= 0) {
        runs.push_back({place(entry.stage), entry.stage == s ? 1.0 : 0.0, entry.qdot, entry.a,
                        entry.start_q, entry.start_qdot});
      }
    }
    if (start_ >= 0 && stencil.reaches_start) {
      runs.push_back({.place = start_ + dof,
                      .a = stencil.a_by_qdot0,
                      .start_qdot = stencil.start_qdot_by_qdot0});
    }
  }
}

Eigen::Index StageLayout::place(int stage) const {
  return stage == 0 ? start_ : head_ + (stage - 1) * Eigen::Index{dof_};
}

}  // namespace hbar
