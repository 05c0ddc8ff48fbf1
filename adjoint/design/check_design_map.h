#pragma once

#include <limits>
#include <string>

#include "hbar/adjoint/design/design_map.h"

namespace hbar {

/// How far a map's Jacobian differs from differences of its values, and its Hessian from
/// differences of its Jacobian.
struct DesignMapCheck {
  /// Largest |central difference − derivative| of a parameter with respect to a variable, over the
  /// norm of that parameter's derivatives; variables in units of their scale.
  double gap = 0.0;
  std::string gap_name;  ///< "parameter 3 by length"; empty if gap is 0
  /// Order in ε of p(d + ε δ) − p(d) − ε J δ along a direction that moves every variable: 2 if J is
  /// right; infinite if the remainder is only rounding, as for a linear map.
  double slope = std::numeric_limits<double>::infinity();
  bool has_hessian = false;  ///< hessian() does not throw; otherwise the members below mean nothing
  /// Largest |central difference of Jᵀ y − column of the Hessian|, over the Hessian's norm or 1,
  /// whichever is larger; variables in units of their scale, parameters in units of their
  /// derivatives, each weighted differently by y.
  double hessian_gap = 0.0;
  std::string hessian_gap_name;  ///< "length and width"; empty if hessian_gap is 0
  /// Order in ε of J(d + ε δ)ᵀ y − J(d)ᵀ y − ε H δ: 2 if H is right; infinite as above.
  double hessian_slope = std::numeric_limits<double>::infinity();
};

/// Compares a map's Jacobian with differences of its values, and its Hessian with differences of
/// its Jacobian.
///
/// @param d  where to check; steps may leave the bounds by 1e-2 of the variables' scale  [d]
/// @throws InvalidInput if d, parameters(d), jacobian(d) or hessian(d, y) has the wrong size
[[nodiscard]] DesignMapCheck check_design_map(const DesignMap& map, const Eigen::VectorXd& d);

}  // namespace hbar
