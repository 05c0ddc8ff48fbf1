#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/adjoint/trajectory/inputs.h"
#include "hbar/adjoint/trajectory/trajectory_values.h"
#include "hbar/core/model/measurement.h"
#include "hbar/core/parameters/parameters.h"
#include "hbar/solvers/newton/newton.h"

namespace hbar {

struct Integrator;

/// The least time step, of which any part of one is: rates go with 1 / h².
inline constexpr double kSmallestStep = 1e-120;

/// How to simulate.
struct SimulationOptions {
  std::string integrator = "bdf1";  ///< a name of integrators()
  double h = 0.02;                  ///< time step, time
  int steps = 100;                  ///< N
  /// Steps at whose beginning a multistep method restarts, as after an event; 0 … N − 1. BDF2 takes
  /// one step of SDIRK2 there.
  std::vector<int> restarts = {};
  solvers::NewtonOptions newton = {};
  /// Additional rows of TrajectoryValues::measured for objectives and constraints.
  std::vector<Measurement> measurements = {};
  int max_halvings = 10;     ///< of a step that does not converge; each is recorded
  bool keep_factors = true;  ///< for the adjoint; not kept if they exceed max_memory
  double max_memory = 4e9;   ///< bytes that a simulation and its gradient may take, as estimated
  /// Ends what runs on this horizon soon after it is set: a simulation before its next step, with a
  /// report; derivatives, linearisations and checks before their next stage, with Interrupted.
  const std::atomic<bool>* stop = nullptr;
};

/// The set-up of a trajectory: a model, its free parameters, and how to simulate it. Everything
/// that computes trajectories, their values or their derivatives is constructed from one.
///
/// Immutable. Copies share their data and are cheap, and so a move is a copy; any number of threads
/// may read one.
class Horizon {
 public:
  /// @throws InvalidInput for no model, parameters of another model, an unknown integrator, h or
  ///         steps that are not positive, a horizon that would not fit into options.max_memory, or
  ///         measurements that the model cannot have
  Horizon(Model model, ParameterSet parameters, SimulationOptions options);
  /// The same for a shared model.
  Horizon(std::shared_ptr<const Model> model, ParameterSet parameters, SimulationOptions options);

  Horizon(const Horizon&) = default;
  Horizon& operator=(const Horizon&) = default;
  ~Horizon() = default;

  /// The same model and parameters with other options.
  /// @throws InvalidInput as the constructors
  [[nodiscard]] Horizon with(SimulationOptions options) const;

  [[nodiscard]] const Model& model() const { return *data_->model; }
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const { return data_->model; }
  [[nodiscard]] const ParameterSet& parameters() const { return data_->parameters; }
  [[nodiscard]] const SimulationOptions& options() const { return data_->options; }
  [[nodiscard]] const Integrator& integrator() const { return *data_->integrator; }
  /// N.
  [[nodiscard]] int steps() const { return data_->options.steps; }
  /// Whether trajectories keep the factors of their stages' Jacobians: requested, and within
  /// max_memory.
  [[nodiscard]] bool keeps_factors() const { return data_->keeps_factors; }

  /// Parameters at their nominal values; controls and initial state zero.
  [[nodiscard]] Inputs nominal_inputs() const;
  /// The model's numbers with parameters applied.
  ///
  /// @param p  values of the parameters                                       [parameters]
  /// @throws InvalidInput as apply_parameters
  [[nodiscard]] std::shared_ptr<const Mechanism<double>> mechanism(const Eigen::VectorXd& p) const;
  /// @throws InvalidInput naming the first input that has another shape or is not finite
  void check(const Inputs& inputs) const;

  /// All that is measured: model_measurements, then SimulationOptions::measurements.
  [[nodiscard]] const std::vector<Measurement>& measurements() const { return data_->measurements; }
  /// Which rows of TrajectoryValues::measured belong to what.
  [[nodiscard]] const MeasuredRows& measured_rows() const { return data_->measured_rows; }
  /// Their names: "NAME" or "NAME.x", … of each measurement.
  [[nodiscard]] const std::vector<std::string>& measured_names() const {
    return data_->measured_names;
  }
  [[nodiscard]] int measured_count() const { return static_cast<int>(measured_names().size()); }
  /// The row of that name.
  /// @throws InvalidInput naming the nearest existing name
  [[nodiscard]] int measured_index(std::string_view name) const;

 private:
  struct Data {
    std::shared_ptr<const Model> model;
    ParameterSet parameters;
    SimulationOptions options;
    const Integrator* integrator = nullptr;
    bool keeps_factors = true;
    std::vector<Measurement> measurements;
    MeasuredRows measured_rows;
    std::vector<std::string> measured_names;
  };

  std::shared_ptr<const Data> data_;
};

}  // namespace hbar
