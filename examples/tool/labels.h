#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/programs/load_problem.h"

namespace hbar::tool {

/// Names of all coordinates, in order.                                        [dof]
[[nodiscard]] std::vector<std::string> coordinate_names(const Model& model);
/// "rad", or the unit of length.                                              [dof]
[[nodiscard]] std::vector<std::string> coordinate_units(const Model& model);
/// Names of all controls, in order.                                           [controls]
[[nodiscard]] std::vector<std::string> control_names(const Model& model);
/// "NAME.x", "NAME.y", "NAME.z" of every end effector, in order.              [variables]
[[nodiscard]] std::vector<std::string> variable_names(const Model& model);
/// Names of all contacts, in order.                                           [contacts]
[[nodiscard]] std::vector<std::string> contact_names(const Model& model);
/// "SENSOR.POINT.shear0", "….shear1", "….normal" of every sensor point, in order.  [tactile]
[[nodiscard]] std::vector<std::string> tactile_names(const Model& model);
/// "m-kg" or "cm-g".
[[nodiscard]] std::string unit_system(const Model& model);
/// "N" or "dyn".
[[nodiscard]] std::string_view force_unit(const Model& model);

/// Names of the objectives, in the order of ObjectiveChoice.
[[nodiscard]] const std::vector<std::string>& objective_names();
[[nodiscard]] const std::string& objective_name(ObjectiveChoice choice);

}  // namespace hbar::tool
