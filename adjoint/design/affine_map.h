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

/// Bounds of a parameter that is itself a design variable.
struct ParameterBounds {
  std::string name;  ///< of a parameter in the set
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// The parameters themselves as design variables, p = d, starting at their nominal values.
///
/// @param bounds  for some of them, within the set's own bounds, which apply to the others
/// @throws InvalidInput for a name that is not in the set, bounds that exclude the nominal value,
///   or a negative lower bound of what cannot be negative
[[nodiscard]] DesignMapPointer parameter_map(const ParameterSet& set,
                                             const std::vector<ParameterBounds>& bounds = {});

/// parameter_map with the principal moments of each body replaced by its second moments of mass
/// s = ∫ (x², y², z²) dm, of which I = (s_y + s_z, s_x + s_z, s_x + s_y): every s > 0 belongs to a
/// physical body, so that simple bounds on d keep the moments positive and the triangle inequality
/// satisfied.
///
/// @param set          contains all three moments of a body, or none
/// @param least_share  lower bound of s, as a share of the body's largest nominal moment, > 0
/// @throws InvalidInput if only some of a body's moments are in the set, or the share is not
///         positive and below 1/2
[[nodiscard]] DesignMapPointer inertia_chart(const ParameterSet& set, double least_share = 1e-3);

}  // namespace hbar
