#pragma once

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/stage/stage_residual.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/benchmarks/mujoco_model.h"

namespace hbar::benchmarks {

inline constexpr double kStep = 0.005;  ///< s
inline constexpr int kSteps = 200;

/// Corrections, and Jacobians evaluated, of all stages of a trajectory.
[[nodiscard]] int newton_iterations(const Trajectory& trajectory);
[[nodiscard]] int factorizations(const Trajectory& trajectory);

/// One stage of a step against one step of MuJoCo's, at the same states in turn.
class StageWork {
 public:
  /// @throws NumericalFailure if the two programs do not have the same mechanism to 1e-9
  explicit StageWork(const HingeModel& hinges);

  void residual();         ///< g
  void jacobian_blocks();  ///< g, and G_q, G_v, c M as three matrices
  void newton_matrix();    ///< g and ∂g/∂q as Newton's method needs it
  void mujoco_step();      ///< mj_step

 private:
  static constexpr std::size_t kPoints = 8;

  [[nodiscard]] const StagePoint<double>& next();

  Model model_;
  MujocoModel mujoco_;
  Mechanism<double> mechanism_;
  StageResidual<double> stage_;
  std::vector<StagePoint<double>> points_;
  std::size_t at_ = 0;
  Eigen::VectorXd g_;
  Eigen::MatrixXd G_q_;
  Eigen::MatrixXd G_v_;
  Eigen::MatrixXd M_;
};

/// A simulation of kSteps steps from a random state under small random controls, and its gradient
/// of ½ Σ ‖v_k‖² by initial state, controls and parameters.
class RolloutWork {
 public:
  /// @param parameters  the first so many of all the model's, or all if it has fewer
  RolloutWork(const HingeModel& hinges, const std::string& integrator, int parameters);

  void forward();                  ///< simulation that keeps factors for the sweep
  void forward_alone();            ///< simulation, nothing kept
  void sweep();                    ///< gradient of the last trajectory
  void forward_and_sweep();        ///< both
  void mujoco_rollout();           ///< the same simulation by mj_step
  void mujoco_rollout_with_A_B();  ///< the same, with mjd_transitionFD at every step

  [[nodiscard]] int parameter_count() const { return horizon_.parameters().size(); }
  [[nodiscard]] int newton_iterations() const;  ///< of the last trajectory, all stages
  [[nodiscard]] int factorizations() const;     ///< of the last trajectory, all stages
  [[nodiscard]] int refactorized() const { return adjoint_.refactorized(); }

 private:
  RolloutWork(const HingeModel& hinges, const Model& model, const std::string& integrator,
              int parameters);

  MujocoModel mujoco_;
  Horizon horizon_;
  Simulator simulator_;
  Simulator bare_;  // keeps nothing
  Inputs inputs_;
  AdjointSweep adjoint_;
  Objective objective_;
  Trajectory trajectory_;
};

}  // namespace hbar::benchmarks
