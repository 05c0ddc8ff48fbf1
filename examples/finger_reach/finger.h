#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hbar/adjoint/design/design_map.h"
#include "hbar/adjoint/terms/constraint.h"

namespace hbar::finger_reach {

/// A part of the finger between two hinges: a cuboid along x, as thick as it is wide.
struct Phalanx {
  std::string body;        ///< its name, and its link's
  std::string next_joint;  ///< the joint at its end
  double length = 0.0;     ///< along x, m
  double width = 0.0;      ///< along y and z, m
  double density = 0.0;    ///< kg/m³
};

/// The phalanges as given in examples/scenes/finger.xml.
/// @throws InvalidInput if the model has no such bodies, or a body is not such a cuboid
[[nodiscard]] std::array<Phalanx, 3> phalanges(const Model& model);

/// The parameters that a phalanx's size determines: the places of the next joint and of its own
/// body, its mass and moments.
///
/// @param payload  the mass at the tip is among them
[[nodiscard]] ParameterSet finger_parameters(const Model& model, bool payload = false);

/// Maps lengths and widths of the phalanges to finger_parameters: d = (3 lengths, 3 widths).
///
/// @param payload  kg at the tip, a seventh variable fixed by its bounds; none unless the tip's
///                 mass is in the set
[[nodiscard]] DesignMapPointer finger_map(const std::array<Phalanx, 3>& phalanges,
                                          const ParameterSet& set,
                                          std::optional<double> payload = {});

/// No phalanx longer than `ratio` times its width, from p alone: width²/length² = m / (ρ length³).
[[nodiscard]] ConstraintPointer slenderness(const std::array<Phalanx, 3>& phalanges,
                                            const ParameterSet& set, double ratio);

}  // namespace hbar::finger_reach
