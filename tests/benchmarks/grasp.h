#pragma once

#include <memory>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/core/model/model.h"

namespace hbar::benchmarks {

/// A hand of five fingers around a free cube: 23 coordinates of the hand (three at the wrist, four
/// per finger) and six of the cube; 15 phalanges of 132 contact points each against the cube.
///
/// @param contacts  without them the fingers pass through the cube
[[nodiscard]] Model grasp_model(bool contacts = true);

/// What a simulation of the grasp costs, and contact's share of it.
class GraspWork {
 public:
  explicit GraspWork(const std::string& integrator);

  void forward();        ///< simulation that keeps factors for the sweep
  void forward_alone();  ///< simulation, nothing kept
  void sweep();          ///< gradient of the last trajectory, all parameters but contact points
  void forward_and_sweep();
  // One evaluation at states of the last trajectory in turn, with contacts and without them.
  void newton_matrix();
  void newton_matrix_without();
  void residual();
  void residual_without();
  void pull_back();
  void pull_back_without();

  [[nodiscard]] int steps() const;
  [[nodiscard]] int stages() const;             ///< of the last trajectory
  [[nodiscard]] int newton_iterations() const;  ///< of the last trajectory
  [[nodiscard]] int factorizations() const;     ///< of the last trajectory
  [[nodiscard]] int declared_points() const;
  [[nodiscard]] double mean_active_points() const;
  [[nodiscard]] int most_active_points() const;
  [[nodiscard]] int parameter_count() const;
  /// Lowest height of the cube over the trajectory less its first: how far it slips, m.
  [[nodiscard]] double slip() const;

 private:
  struct Workspace;
  std::shared_ptr<Workspace> work_;
};

}  // namespace hbar::benchmarks
