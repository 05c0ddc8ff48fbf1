#pragma once

#include <string_view>

#include "hbar/adjoint/trajectory/value_place.h"

namespace hbar {

class Horizon;
class Model;
class ParameterSet;

/// World axes, as row numbers of anything with three rows.
enum Axis { kX, kY, kZ };

/// Numbers of a trajectory by their names, for terms that read single ones:
///
///     generic_term("reach", {place::end_effector(model, "tip", kX, 100)},
///                  [](auto v) { return v[0] * v[0]; })
///
/// A state has steps 0 … N, a control 0 … N − 1. Each throws InvalidInput for an unknown name,
/// suggesting the nearest one, and for a negative step.
namespace place {

/// @param name  as in ParameterSet: "body.rod.mass"
[[nodiscard]] ValuePlace parameter(const ParameterSet& set, std::string_view name);

/// @param name  as Model::coordinate_name: the joint's, and the coordinate's if there are several
[[nodiscard]] ValuePlace coordinate(const Model& model, std::string_view name, int step);

/// The rate q̇ of a coordinate.
[[nodiscard]] ValuePlace rate(const Model& model, std::string_view coordinate, int step);

/// @param name  as Model::control_name: the motor's joint, and the coordinate's where there are
///              several
[[nodiscard]] ValuePlace control(const Model& model, std::string_view name, int step);

/// A coordinate of an end effector's position in the world.
[[nodiscard]] ValuePlace end_effector(const Model& model, std::string_view name, Axis axis,
                                      int step);

/// @param name  one of Horizon::measured_names: "grip.normal"
[[nodiscard]] ValuePlace measured(const Horizon& horizon, std::string_view name, int step);

}  // namespace place
}  // namespace hbar
