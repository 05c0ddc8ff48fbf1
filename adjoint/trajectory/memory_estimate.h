#pragma once

#include <string>

namespace hbar {

class Horizon;
class Model;

/// What a simulation and its gradient by AdjointSweep hold at their peaks, bytes. It is estimated
/// from counts alone before anything is allocated, and within a factor of 1.3 of what they then
/// allocate (tests/adjoint/trajectory/memory_estimate_test.cpp). Steps that are halved add stages
/// that no estimate knows of; the caller's own inputs and the model are not counted.
struct MemoryEstimate {
  double workspace = 0.0;   ///< of one stage: grows with the model, not with the steps
  double trajectory = 0.0;  ///< a Trajectory without factors
  double factors = 0.0;     ///< of every stage, if they are kept
  double gradient = 0.0;    ///< values, partials and adjoints, beside the trajectory

  /// Of all together. With or without factors.
  [[nodiscard]] double total(bool with_factors) const {
    return workspace + trajectory + (with_factors ? factors : 0.0) + gradient;
  }
};

/// The counts on which it depends, beside the model.
struct MemoryCounts {
  std::string integrator;  ///< a name of integrators()
  int steps = 0;           ///< N
  int restarts = 0;        ///< of a multistep method
  int measured = 0;        ///< rows of TrajectoryValues::measured
  int parameters = 0;      ///< free ones
};

/// @throws InvalidInput for an unknown integrator
[[nodiscard]] MemoryEstimate estimate_memory(const Model& model, const MemoryCounts& counts);
/// The same of a horizon.
[[nodiscard]] MemoryEstimate estimate_memory(const Horizon& horizon);

/// @param limit  SimulationOptions::max_memory, bytes
/// @throws InvalidInput if simulation and gradient without factors would take more; it says what
///   was estimated, what the limit is and what helps
void require_memory(const Model& model, int steps, const MemoryEstimate& estimate, double limit);

}  // namespace hbar
