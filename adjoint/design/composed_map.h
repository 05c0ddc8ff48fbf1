#pragma once

#include "hbar/adjoint/design/design_map.h"

namespace hbar {

/// p = outer(inner(d)): what a designer changes decides the variables of another map, as lengths
/// decide sizes that decide masses. Derivatives by the chain rule, second ones too where both maps
/// have them. The inner map's variables are those of the composition; the outer map's bounds are
/// not imposed.
///
/// @throws InvalidInput if a map is null, or `inner` does not give as many numbers as `outer` takes
[[nodiscard]] DesignMapPointer compose(DesignMapPointer outer, DesignMapPointer inner);

}  // namespace hbar
