#pragma once

#include "hbar/adjoint/design/design_map.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// p = base + slopes d.
///
/// @param base    p at d = 0                                                  [parameters]
/// @param slopes  dp/dd                                                       [parameters x d]
/// @throws InvalidInput if the sizes do not fit, or a number is not finite
[[nodiscard]] DesignMapPointer affine_map(DesignVariables variables, Eigen::VectorXd base,
                                          Eigen::MatrixXd slopes);

/// Bounds of a parameter that is a design variable itself.
struct ParameterBounds {
  std::string name;  ///< of a parameter in the set
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// The parameters themselves as design variables, p = d, starting at their nominal values.
///
/// @param bounds  of some of them, within the set's own, which hold for the others
/// @throws InvalidInput for a name that is not in the set, or bounds without the nominal value
[[nodiscard]] DesignMapPointer parameter_map(const ParameterSet& set,
                                             const std::vector<ParameterBounds>& bounds = {});

/// parameter_map with the principal moments of each body replaced by its second moments of mass
/// s = ∫ (x², y², z²) dm, of which I = (s_y + s_z, s_x + s_z, s_x + s_y): every s > 0 is a body
/// that exists, so that bounds on d alone keep positive moments and the triangle inequality.
///
/// @param set          holds all three moments of a body, or none of them
/// @param least_share  lower bound of s, as a share of the body's largest nominal moment, > 0
/// @throws InvalidInput if only some of a body's moments are in the set, or the share is not
///         positive and below 1/2
[[nodiscard]] DesignMapPointer inertia_chart(const ParameterSet& set, double least_share = 1e-3);

}  // namespace hbar
