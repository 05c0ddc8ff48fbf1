#pragma once

#include "hbar/adjoint/design/design_map.h"
#include "hbar/adjoint/study/information.h"
#include "hbar/adjoint/study/trajectory_csv.h"
#include "hbar/adjoint/terms/objective.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"

namespace hbar::study {

/// ½ weight Σ ((value − datum) / σ)² over what was measured: with weight 1 and independent normal
/// errors, minus the logarithm of the likelihood. Missing data do not enter the sum. The second
/// partials form a diagonal.
///
/// @param sigma  standard deviation > 0 of each datum, or one for all            [data or 1]
/// @throws InvalidInput if sizes disagree, a number is not finite or a σ is not positive; later, if
///   a place is not in the simulation
[[nodiscard]] std::shared_ptr<const ObjectiveTerm> measured_data_term(const TrajectoryData& data,
                                                                      const Eigen::VectorXd& sigma,
                                                                      double weight = 1.0);

/// Options of fisher_information.
struct IdentificationOptions {
  InformationOptions information = {};
  /// The initial coordinates and rates are estimated as well: dof + dof parameters after d, named
  /// "initial NAME" and "initial rate.NAME", with the scale 1.
  bool initial_state = false;
};

/// The derivatives of the measured numbers with respect to design variables and, if `initial_state`
/// is set, to the initial state: a TangentSweep with one column for each.
///
/// @param trajectory  complete, of this horizon, with p = map.parameters(d)
/// @param d           design variables                                               [d]
/// @returns  one row per datum                                                       [data x k]
/// @throws InvalidInput if sizes disagree, the trajectory has other parameters, or a place is not
///   in the simulation
/// @throws NumericalFailure as TangentSweep::push_forward
[[nodiscard]] Eigen::MatrixXd data_sensitivity(const Horizon& horizon, const Trajectory& trajectory,
                                               const DesignMap& map, const Eigen::VectorXd& d,
                                               const TrajectoryData& data,
                                               bool initial_state = false);

/// How well measured data determine design variables: F = Σ (∂value/∂d)ᵀ (∂value/∂d) / σ² at an
/// estimate, the covariance F⁻¹ and what follows from it (information.h).
///
/// @param d      the estimate: the minimiser of measured_data_term                   [d]
/// @param sigma  standard deviation of each datum, or one for all                    [data or 1]
/// @throws as data_sensitivity and information
[[nodiscard]] Information fisher_information(const Horizon& horizon, const Trajectory& trajectory,
                                             const DesignMap& map, const Eigen::VectorXd& d,
                                             const TrajectoryData& data,
                                             const Eigen::VectorXd& sigma,
                                             const IdentificationOptions& options = {});

}  // namespace hbar::study
