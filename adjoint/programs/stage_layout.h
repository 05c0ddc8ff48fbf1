#pragma once

#include <vector>

#include "hbar/adjoint/programs/input_variables.h"
#include "hbar/adjoint/trajectory/timeline.h"

namespace hbar {

/// How a stage's q, q̇, q̈ and step start depend on one run of dof entries of x.
struct StageRun {
  Eigen::Index place = 0;  ///< of the run's first entry
  double q = 0.0;
  double qdot = 0.0;
  double a = 0.0;
  double start_q = 0.0;
  double start_qdot = 0.0;
};

/// Where all-at-once keeps the coordinates of the stages, x = [ InputVariables | q of stage 1 | q
/// of stage 2 | … ], and how each stage depends on x by the integrator's stencil.
class StageLayout {
 public:
  /// @param dof  of the model
  StageLayout(const InputVariables& head, const Timeline& timeline, int dof);

  [[nodiscard]] int dof() const { return dof_; }
  [[nodiscard]] int stage_count() const { return static_cast<int>(runs_.size()); }
  /// The runs that a stage depends on.
  [[nodiscard]] const std::vector<StageRun>& runs(int stage) const {
    return runs_[static_cast<std::size_t>(stage)];
  }
  /// Place in x of a stage's first coordinate; −1 for stage 0 if the initial state is not a
  /// variable.
  [[nodiscard]] Eigen::Index place(int stage) const;
  /// The step that a stage ends, or −1.
  [[nodiscard]] int step_ended_by(int stage) const {
    return steps_ended_[static_cast<std::size_t>(stage)];
  }
  /// The stage that ends step k − 1; 0 is the start.
  [[nodiscard]] int stage_of_step(int k) const { return ends_[static_cast<std::size_t>(k)]; }
  /// The step that a stage belongs to; 0 for the start.
  [[nodiscard]] int step_of(int stage) const { return steps_[static_cast<std::size_t>(stage)]; }

 private:
  int dof_ = 0;
  Eigen::Index head_ = 0;                    // size of what comes first in x
  Eigen::Index start_ = -1;                  // place of q₀
  std::vector<std::vector<StageRun>> runs_;  // per stage
  std::vector<int> steps_ended_;             // per stage
  std::vector<int> steps_;                   // per stage
  std::vector<int> ends_;                    // per step 0 … N
};

}  // namespace hbar
