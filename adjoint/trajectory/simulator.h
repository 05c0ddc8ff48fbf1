#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hbar/adjoint/outputs/end_effectors.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/contact/tactile.h"
#include "hbar/core/model/measurement.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// How to simulate.
struct SimulationOptions {
  std::string integrator = "bdf1";  ///< a name of integrators()
  double h = 0.02;                  ///< time step, time
  int steps = 100;                  ///< N
  /// Steps at whose beginning a multistep method starts anew, as after an event; 0 … N − 1. BDF2
  /// then takes a step of SDIRK2 there.
  std::vector<int> restarts = {};
  solvers::NewtonOptions newton = {};
  /// Rows of TrajectoryValues::measured, for objectives and constraints to read.
  std::vector<Measurement> measurements = {};
  int max_halvings = 10;                    ///< of a step that does not converge; each is recorded
  bool keep_factors = true;                 ///< for the adjoint; dropped if they exceed max_memory
  double max_memory = 4e9;                  ///< bytes that a trajectory may take
  const std::atomic<bool>* stop = nullptr;  ///< checked before each step
};

/// How a simulation ended.
enum class RolloutStatus { kConverged, kInterrupted, kStepFailed };

/// What a simulation did, in words and numbers.
struct RolloutReport {
  RolloutStatus status = RolloutStatus::kStepFailed;
  int steps_done = 0;
  double time = 0.0;                  ///< reached
  double smallest_h = 0.0;            ///< of all steps and their parts
  solvers::NewtonReport last_newton;  ///< of the stage that was computed last
  std::string message;                ///< empty if converged; else what happened and what to try
};

/// A simulation's outcome: a report, and the trajectory as far as it got.
class [[nodiscard]] Rollout {
 public:
  Rollout(RolloutReport report, Trajectory trajectory)
      : report_(std::move(report)), trajectory_(std::move(trajectory)) {}

  [[nodiscard]] bool converged() const { return report_.status == RolloutStatus::kConverged; }
  [[nodiscard]] const RolloutReport& report() const { return report_; }
  /// The whole trajectory.
  /// @throws NumericalFailure with the report's message if it is not whole
  [[nodiscard]] const Trajectory& trajectory() const&;
  [[nodiscard]] Trajectory trajectory() &&;
  /// What was reached, whole or not.
  [[nodiscard]] const Trajectory& partial() const { return trajectory_; }

 private:
  RolloutReport report_;
  Trajectory trajectory_;
};

/// What objectives, constraints and result files read. Time runs along columns, k = 0 … N.
struct TrajectoryValues {
  double h = 0.0;            ///< nominal time step
  Eigen::MatrixXd q;         ///< rad or length                               [dof x N+1]
  Eigen::MatrixXd qdot;      ///<                                             [dof x N+1]
  Eigen::MatrixXd v;         ///< auxiliary variables, length                 [variables x N+1]
  Eigen::MatrixXd tactile;   ///< sensor readings, force                   [readings x N+1]
  Eigen::MatrixXd measured;  ///< measurements                               [measured x N+1]
  Eigen::MatrixXd u;         ///< controls                                    [controls x N]
  Eigen::VectorXd p;         ///< design parameters                           [parameters]
};

/// Solves ḡ(q̄, p) = 0 stage by stage: the forward simulation.
///
/// Holds its workspace and belongs to one thread at a time; another thread makes its own.
class Simulator {
 public:
  /// @throws InvalidInput for an unknown integrator, h or steps that are not positive, a horizon
  ///         that would not fit into options.max_memory, or measurements that the model cannot have
  Simulator(Model model, ParameterSet parameters, SimulationOptions options);
  /// The same of a model that others use, too.
  Simulator(std::shared_ptr<const Model> model, ParameterSet parameters, SimulationOptions options);
  ~Simulator();
  /// Copies share the model and have a workspace of their own.
  Simulator(const Simulator& other);
  Simulator& operator=(const Simulator& other);
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Parameters at their nominal values, controls and initial state zero.
  [[nodiscard]] Inputs nominal_inputs() const;

  /// Simulates. A step whose Newton solve fails is halved, up to max_halvings times over.
  ///
  /// @throws InvalidInput if an input has another shape, is not finite or is not physical
  Rollout rollout(const Inputs& inputs);

  /// The values at the steps' ends of a trajectory of this simulator. Measurements read the control
  /// of the step that ends, at k = 0 that of the first step.
  [[nodiscard]] TrajectoryValues values(const Trajectory& trajectory);

  /// What each contact did at the steps' ends: [step 0 … N][contact].
  [[nodiscard]] std::vector<std::vector<ContactSummary>> contact_history(
      const Trajectory& trajectory);

  /// Sets `point` to a stage of a trajectory.
  void set_point(const Trajectory& trajectory, int stage, StagePoint<double>& point);

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const { return model_; }
  [[nodiscard]] const ParameterSet& parameters() const { return parameters_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  /// Names of the rows of TrajectoryValues::measured: "NAME" or "NAME.x", … of each measurement.
  [[nodiscard]] const std::vector<std::string>& measured_names() const;
  [[nodiscard]] int measured_count() const { return static_cast<int>(measured_names().size()); }
  /// The row of that name.
  /// @throws InvalidInput naming the nearest existing name
  [[nodiscard]] int measured_index(std::string_view name) const;

 private:
  class StageSystem;
  struct Workspace;

  void check_options() const;
  void check_inputs(const Inputs& inputs) const;
  bool advance(Trajectory& trajectory, int step, double h, int depth, RolloutReport& report);
  bool solve_stage(Trajectory& trajectory, int stage, RolloutReport& report);
  [[nodiscard]] bool strays(const Eigen::VectorXd& predicted, const Eigen::VectorXd& found) const;
  void switch_charts(Trajectory& trajectory) const;
  [[nodiscard]] std::string deepest_contact() const;
  [[nodiscard]] std::string failure_message(const Trajectory& trajectory, int step,
                                            const RolloutReport& report) const;
  [[nodiscard]] double bytes_per_stage(bool with_factors) const;

  std::shared_ptr<const Model> model_;
  ParameterSet parameters_;
  SimulationOptions options_;
  const Integrator* integrator_ = nullptr;
  bool keep_factors_ = true;
  std::unique_ptr<Workspace> work_;
};

}  // namespace hbar
