#pragma once

#include "hbar/adjoint/terms/separable_term.h"

namespace hbar {

// Every term here has exact second partials. A weight is ≥ 0 unless its term says otherwise;
// `steps` weights each summand of a sum over steps (see StepWeights).

/// ½ weight Σ_{k=1…N} ‖v_k‖² over all auxiliary variables.
[[nodiscard]] TermPointer squared_variables(double weight = 1.0, const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N} ‖tactile_k‖² over all sensor readings.
[[nodiscard]] TermPointer squared_tactile(double weight = 1.0, const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N} ‖measured_k‖² over measured rows.
///
/// @param rows  Horizon::measured_index; empty: those of SimulationOptions::measurements
[[nodiscard]] TermPointer squared_measured(double weight = 1.0, const std::vector<int>& rows = {},
                                           const StepWeights& steps = {});

/// ½ weight ‖q_N‖².
[[nodiscard]] TermPointer squared_final_position(double weight = 1.0);

/// ½ weight Σ_{k=1…N} ‖q_k − target_k‖².
///
/// @param target  column k − 1 is step k's target, or one column for all     [dof x N or 1]
[[nodiscard]] TermPointer tracking(Eigen::MatrixXd target, double weight = 1.0,
                                   const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N} ‖v_k − target_k‖² on the auxiliary variables.
///
/// @param target  column k − 1 is step k's target, or one column for all     [variables x N or 1]
[[nodiscard]] TermPointer variable_tracking(Eigen::MatrixXd target, double weight = 1.0,
                                            const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N} ‖measured_k − target_k‖² on the measured rows.
///
/// @param rows    Horizon::measured_index; empty: those of SimulationOptions::measurements
/// @param target  column k − 1 is step k's target, or one column for all     [rows x N or 1]
[[nodiscard]] TermPointer measured_tracking(const std::vector<int>& rows, Eigen::MatrixXd target,
                                            double weight = 1.0, const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N} ‖x_k − target_k‖² on any rows of any member but p.
///
/// @param field   the member x
/// @param rows    of the member; empty: all
/// @param target  column k − 1 is step k's target, or one column for all     [rows x N or 1]
[[nodiscard]] TermPointer tracking_of(ValueField field, const std::vector<int>& rows,
                                      Eigen::MatrixXd target, double weight = 1.0,
                                      const StepWeights& steps = {});

/// ½ (weight_q ‖q_N − q‖² + weight_qdot ‖q̇_N − q̇‖²).
///
/// @param q, qdot  desired state at the end                                  [dof]
[[nodiscard]] TermPointer terminal_state(Eigen::VectorXd q, Eigen::VectorXd qdot, double weight_q,
                                         double weight_qdot);

/// ½ weight h Σ_k ‖u_k‖².
[[nodiscard]] TermPointer effort(double weight = 1.0, const StepWeights& steps = {});

/// ½ weight h Σ_{k=1…N} ‖q̇_k‖².
[[nodiscard]] TermPointer squared_velocity(double weight = 1.0, const StepWeights& steps = {});

/// ½ weight Σ_{k=1…N−1} ‖u_k − u_{k−1}‖² / h: half the integral of the controls' squared rates. The
/// change from u_{k−1} to u_k has the weight of step k + 1.
[[nodiscard]] TermPointer control_smoothness(double weight = 1.0, const StepWeights& steps = {});

/// weight h Σ_{k=1…N} Σ_rows (√(P² + ε²) − ε) over measured powers P: the work of motors that
/// recover no energy. ε rounds off the corner of |P|; the cost of P = 0 is subtracted.
///
/// @param rows       Horizon::measured_index
/// @param smoothing  ε > 0, power: a small share of the powers that matter
[[nodiscard]] TermPointer work(const std::vector<int>& rows, double smoothing, double weight = 1.0,
                               const StepWeights& steps = {});

/// weight h Σ_{k=1…N} Σ_rows P over measured powers: the signed work, where braking recovers
/// energy. Linear.
[[nodiscard]] TermPointer net_work(const std::vector<int>& rows, double weight = 1.0,
                                   const StepWeights& steps = {});

/// weight h Σ_{k=1…N} Σ_rows x over any member but p. Linear; the weight may be negative.
///
/// @param field  the member x
/// @param rows   of the member; empty: all
[[nodiscard]] TermPointer time_integral(ValueField field, const std::vector<int>& rows,
                                        double weight = 1.0, const StepWeights& steps = {});

/// weight · x_N, such as a distance reached: the last column of any member but p. Linear; a
/// negative weight maximises it.
///
/// @param field  the member x
/// @param index  row of the member
[[nodiscard]] TermPointer final_number(ValueField field, int index, double weight = 1.0);

/// Σ weight · number: a linear cost of any numbers, including parameters.
///
/// @param places   each at most once
/// @param weights  of any sign                                                 [places]
/// @throws InvalidInput if the sizes differ, a weight is not finite, or a place is named twice
[[nodiscard]] TermPointer weighted_numbers(std::string name, std::vector<ValuePlace> places,
                                           Eigen::VectorXd weights);

/// The second partials of a custom term, and the functions that list and write them.
struct TermSecondPartials {
  /// As ObjectiveTerm::second_places
  std::function<std::vector<SecondPlace>(const TrajectoryValues&)> places;
  /// As ObjectiveTerm::second_partials
  std::function<void(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>)> partials;
};

/// A custom term: a value, and a function that adds its partials (check_objective_term and
/// check_gradient tell whether they agree). generic_term needs only a formula.
///
/// @param second  for exact Hessians; without it second_places() throws InvalidInput
/// @throws InvalidInput if a function is empty, or only one of the two of `second` is given
[[nodiscard]] TermPointer user_term(
    std::string name, std::function<double(const TrajectoryValues&)> value,
    std::function<void(const TrajectoryValues&, TrajectoryPartials&)> add_partials,
    TermSecondPartials second = {});

}  // namespace hbar
