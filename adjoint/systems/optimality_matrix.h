#pragma once

#include <functional>
#include <string>

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/solvers/linear/solver_options.h"

namespace hbar {

/// Weights of the two optimisation systems. Rows of ḡ are scaled to a largest entry of 1 (D).
struct SystemOptions {
  double tracking = 1.0;    ///< w, on what is tracked: the variables v, or q if there are none
  double forces = 1.0;      ///< ρ, kGaussNewton: on the forces that act in addition to the motors
  double effort = 1e-2;     ///< kKkt: on controls
  double damping = 1e-6;    ///< λ > 0, on every unknown of the optimisation
  double slack = 1e-8;      ///< kKkt: −slack·I is the multipliers' diagonal block, > 0
  bool parameters = false;  ///< kKkt: design parameters are unknowns too (last: a border)
};

/// A linear system, with what a solver and its messages need to know about it.
struct AssembledSystem {
  solvers::SparseMatrix A;         ///<                                            [m x m]
  Eigen::VectorXd b;               ///< a right-hand side, see assemble_system      [m]
  solvers::SolverOptions options;  ///< structure and blocks, in time order
  std::function<std::string(int)> name_of_unknown;  ///< "stage 3 (t = 0.04), coordinate elbow"
};

/// Fills A, b and options for kGaussNewton: SᵀS + λI and √w Eᵀ·1.
///
/// @param linearization  of the trajectory
void fill_gauss_newton(const Horizon& horizon, const Trajectory& trajectory,
                       const Linearization& linearization, const SystemOptions& weights,
                       AssembledSystem& out);

/// Fills A, b, options and names for kKkt. Stage by stage, the unknowns are the coordinates, the
/// controls of a step that begins there, and the multipliers of the stage's residual:
///
///     [ w EᵀE + λI                H̄ᵀD        ]
///     [              (r + λ) I    ∂ḡ/∂uᵀ D    ]      r: effort, D: row scales of H̄
///     [ D H̄          D ∂ḡ/∂u     −slack I    ]
///
/// and with weights.parameters a last block of design parameters, λI and D ∂ḡ/∂p.
void fill_kkt(const Horizon& horizon, const Trajectory& trajectory,
              const Linearization& linearization, const SystemOptions& weights,
              AssembledSystem& out);

}  // namespace hbar
