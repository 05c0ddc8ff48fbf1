#pragma once

#include <Eigen/LU>
#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/trajectory/inputs.h"
#include "hbar/adjoint/trajectory/timeline.h"
#include "hbar/core/base/scalar.h"
#include "hbar/core/parameters/parameters.h"
#include "hbar/solvers/newton/newton.h"

namespace hbar {

/// From stage + 1 on, the exponential coordinates of `node` are in the other chart (chart.h).
struct ChartSwitch {
  int stage = 0;
  int node = 0;
};

/// A computed trajectory q̄: the coordinates and rates of every stage, and what later passes reuse.
struct Trajectory {
  std::shared_ptr<const Model> model;  ///< whose it is
  ParameterSet parameters;             ///< of inputs.p
  std::string integrator;              ///< name of the method of its steps
  Timeline timeline;
  Inputs inputs;  ///< what it was computed from
  /// The model's numbers with inputs.p applied, computed once for all that read the trajectory.
  std::shared_ptr<const Mechanism<double>> mechanism;
  Eigen::MatrixXd q;                          ///< per stage, column 0 is q0      [dof x stages]
  Eigen::MatrixXd qdot;                       ///< per stage                      [dof x stages]
  std::vector<ChartSwitch> chart_switches;    ///< ascending by stage
  std::vector<solvers::NewtonReport> newton;  ///< per stage; entry 0 is unused
  /// Factors of ∂g/∂q that Newton left at each stage, near the solution; empty if not kept.
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXd>> factors;

  [[nodiscard]] int step_count() const { return timeline.step_count(); }
  [[nodiscard]] auto q_at_step(int k) const { return q.col(timeline.step_end(k)); }
  [[nodiscard]] auto qdot_at_step(int k) const { return qdot.col(timeline.step_end(k)); }
  /// Newton corrections of step k, all its stages together.
  [[nodiscard]] int newton_iterations(int k) const;
};

}  // namespace hbar
