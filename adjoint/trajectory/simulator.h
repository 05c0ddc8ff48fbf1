#pragma once

#include <string>
#include <utility>

#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/owned.h"

namespace hbar {

/// How a simulation ended.
enum class RolloutStatus { kConverged, kInterrupted, kStepFailed };

/// What a simulation did, in words and numbers.
struct RolloutReport {
  RolloutStatus status = RolloutStatus::kStepFailed;
  int steps_done = 0;
  double time = 0.0;                  ///< reached
  double smallest_h = 0.0;            ///< of all steps and their parts
  solvers::NewtonReport last_newton;  ///< of the last stage computed
  std::string message;                ///< empty if converged, else what happened and what to try
};

/// A simulation's outcome: a report, and the trajectory up to where it stopped.
class [[nodiscard]] Rollout {
 public:
  Rollout(RolloutReport report, Trajectory trajectory)
      : report_(std::move(report)), trajectory_(std::move(trajectory)) {}

  [[nodiscard]] bool converged() const { return report_.status == RolloutStatus::kConverged; }
  [[nodiscard]] const RolloutReport& report() const { return report_; }
  /// The complete trajectory.
  /// @throws NumericalFailure with the report's message if it is incomplete
  /// @throws Interrupted      with it if that is because the stop flag was set
  [[nodiscard]] const Trajectory& trajectory() const&;
  [[nodiscard]] Trajectory trajectory() &&;
  /// The trajectory as far as it got, complete or not.
  [[nodiscard]] const Trajectory& partial() const { return trajectory_; }

 private:
  RolloutReport report_;
  Trajectory trajectory_;
};

/// Solves ḡ(q̄, p) = 0 stage by stage: the forward simulation.
///
/// Holds its workspace and belongs to one thread at a time; another thread makes its own.
class Simulator {
 public:
  explicit Simulator(Horizon horizon);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Simulates. A step whose Newton solve fails is halved, up to max_halvings times.
  ///
  /// @throws InvalidInput if an input has another shape, is not finite, or is not physical
  Rollout rollout(const Inputs& inputs);

  [[nodiscard]] const Horizon& horizon() const { return horizon_; }

 private:
  class StageSystem;
  struct Workspace;

  bool advance(Trajectory& trajectory, int step, double h, int depth, RolloutReport& report);
  bool solve_stage(Trajectory& trajectory, int stage, RolloutReport& report);
  [[nodiscard]] std::string deepest_contact() const;
  [[nodiscard]] std::string failure_message(const Trajectory& trajectory, int step,
                                            const RolloutReport& report) const;

  Horizon horizon_;
  Owned<Workspace> work_;
};

/// Simulates once with a temporary Simulator.
/// @throws InvalidInput as Simulator::rollout
Rollout simulate(const Horizon& horizon, const Inputs& inputs);

}  // namespace hbar
