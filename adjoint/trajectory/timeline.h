#pragma once

#include <array>
#include <vector>

#include "hbar/adjoint/trajectory/integrator.h"

namespace hbar {

/// A weight of a stage on an earlier one.
struct StageWeight {
  int stage = 0;
  double weight = 0.0;  ///< C / h, 1/time
  friend bool operator==(const StageWeight&, const StageWeight&) = default;
};

/// One block of unknowns q of the trajectory q̄, and how its rates follow from the states:
/// q̇ = rate q + Σ weight q_j and q̈ = rate q̇ + Σ weight q̇_j over the earlier stages.
struct Stage {
  static constexpr int kMaxHistory = 3;

  int step = -1;      ///< the step whose controls act
  double time = 0.0;  ///< at its end
  double rate = 0.0;  ///< C_own / h, 1/time
  int start = 0;      ///< stage at which its step (or part of one) starts
  int history_size = 0;
  std::array<StageWeight, kMaxHistory> history;

  friend bool operator==(const Stage&, const Stage&) = default;
};

/// The stages of a trajectory in time order. Stage 0 is the initial state: its q and q̇ are given.
/// Holds everything that linear algebra needs to know about time stepping; halved steps and
/// restarted methods are just further rows.
class Timeline {
 public:
  Timeline();

  /// Makes room for that many stages and steps, stage 0 included; more may follow.
  void reserve(int stages, int steps);

  /// Appends the stages of one step, or of a part of one, with step size h. A method that needs
  /// more equal steps than there are is started by its starter.
  ///
  /// @param step  index of the step whose controls act
  void append(const Integrator& integrator, int step, double h);

  /// Makes the next step a fresh start, as after an event: it looks back no further than its own
  /// start.
  void restart() { ends_.back().h = 0.0; }

  /// Marks the last stage as the end of its step.
  void end_step() { step_ends_.push_back(last_stage()); }

  /// Removes everything after the first `stages` stages (a failed attempt).
  void truncate(int stages);

  [[nodiscard]] int stage_count() const { return static_cast<int>(stages_.size()); }
  [[nodiscard]] int last_stage() const { return stage_count() - 1; }
  [[nodiscard]] const Stage& stage(int s) const { return stages_[static_cast<std::size_t>(s)]; }
  /// Number of finished steps.
  [[nodiscard]] int step_count() const { return static_cast<int>(step_ends_.size()) - 1; }
  /// The stage that ends step k − 1; 0 for k = 0.
  [[nodiscard]] int step_end(int k) const { return step_ends_[static_cast<std::size_t>(k)]; }

  friend bool operator==(const Timeline& a, const Timeline& b) {
    return a.stages_ == b.stages_ && a.step_ends_ == b.step_ends_;
  }

 private:
  /// An end of a step or of a part of one, and the size of what it ended.
  struct End {
    int stage = 0;
    double h = 0.0;
  };

  std::vector<Stage> stages_;
  std::vector<int> step_ends_;
  std::vector<End> ends_;
};

/// The stages of `steps` steps of size h, none of them halved.
///
/// @param restarts  steps at which the method restarts
[[nodiscard]] Timeline even_timeline(const Integrator& integrator, double h, int steps,
                                     const std::vector<int>& restarts = {});

}  // namespace hbar
