#pragma once

#include <Eigen/LU>
#include <vector>

#include "hbar/adjoint/trajectory/timeline.h"
#include "hbar/solvers/newton/newton.h"

namespace hbar {

/// What a simulation is a function of. Time runs along columns.
struct Inputs {
  Eigen::VectorXd p;   ///< design parameters, in the ParameterSet's order      [parameters]
  Eigen::MatrixXd u;   ///< controls, column k acts during step k               [controls x steps]
  Eigen::VectorXd q0;  ///< initial coordinates                                 [dof]
  Eigen::VectorXd qdot0;  ///< their rates                                         [dof]
};

/// The step whose control measurements at the end of step k − 1 read: the one that ends there; at
/// the start, the first.
[[nodiscard]] constexpr int measured_step(int k) { return k > 0 ? k - 1 : 0; }

/// From stage + 1 on, the exponential coordinates of `node` are in the other chart (chart.h).
struct ChartSwitch {
  int stage = 0;
  int node = 0;
};

/// A computed trajectory q̄: every stage's coordinates and rates, and what later passes reuse.
struct Trajectory {
  Timeline timeline;
  Inputs inputs;                              ///< what it was computed from
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
