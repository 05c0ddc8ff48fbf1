#pragma once

#include <utility>
#include <vector>

#include "hbar/adjoint/derivatives/stage_hessian.h"
#include "hbar/adjoint/programs/entry_plan.h"
#include "hbar/adjoint/programs/value_dependence.h"

namespace hbar {

/// The curvature of all-at-once: second derivatives of λᵀ ḡ + y·measured with respect to x, where y
/// are the weights on what is measured. Stage by stage, StageHessian is contracted with the
/// multipliers and mapped to coordinates by the integrator's stencil.
class AllAtOnceHessian {
 public:
  /// @param head, layout  must outlive this object
  AllAtOnceHessian(const TrajectoryProblem& problem, const InputVariables& head,
                   const StageLayout& layout, const ValueDependence& values);

  /// Declares its entries, in the order in which put() fills them.
  void add(EntryPlan& entries) const;

  /// Fills them.
  ///
  /// @param d             design variables                                                  [d]
  /// @param map_jacobian  of the design map there                              [parameters x d]
  /// @param z             multipliers of ḡ                                   [dof·(stages − 1)]
  /// @param weights       on the trajectory's values; only those on measurements and on parameters
  ///                      are read
  void put(const Trajectory& trajectory, const Eigen::VectorXd& d,
           const Eigen::MatrixXd& map_jacobian, const Eigen::VectorXd& z,
           const TrajectoryPartials& weights, EntryPlan& entries);

 private:
  void lay_out_pairs(const Horizon& horizon, const ValueDependence& values);
  void lay_out_gains(const Horizon& horizon);
  [[nodiscard]] const std::vector<int>& pairs_of(const StageRun& a, const StageRun& b,
                                                 int coordinate) const;
  void add_stage(int stage, EntryPlan& entries) const;
  void put_stage(int stage, const StageCurvature& h, EntryPlan& entries) const;

  DesignMapPointer map_;
  const InputVariables& head_;
  const StageLayout& layout_;
  StageHessian stage_;
  std::vector<std::vector<int>> pairs_;             // per coordinate: those it bends numbers with
  std::vector<std::vector<int>> own_pairs_;         // and where neither moves by its rate
  std::vector<std::pair<int, int>> control_rates_;  // (control, coordinate) of measured powers
  std::vector<std::pair<Eigen::Index, int>> gain_controls_;  // (design variable, control)
  bool reads_controls_ = false;                              // what is measured does
};

}  // namespace hbar
