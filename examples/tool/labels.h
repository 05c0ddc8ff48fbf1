#pragma once

#include <string>
#include <vector>

#include "hbar/core/model.h"

namespace hbar::tool {

/// Names of all coordinates, in order.                                        [dof]
[[nodiscard]] std::vector<std::string> coordinate_names(const Model& model);
/// "rad", or the unit of length.                                              [dof]
[[nodiscard]] std::vector<std::string> coordinate_units(const Model& model);
/// Names of all controls, in order.                                           [controls]
[[nodiscard]] std::vector<std::string> control_names(const Model& model);
/// "NAME.x", "NAME.y", "NAME.z" of every end effector, in order.              [variables]
[[nodiscard]] std::vector<std::string> variable_names(const Model& model);
/// "m-kg" or "cm-g".
[[nodiscard]] std::string unit_system(const Model& model);

}  // namespace hbar::tool
