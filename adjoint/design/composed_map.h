#pragma once

#include "hbar/adjoint/design/design_map.h"

namespace hbar {

/// p = outer(inner(d)): the inner map computes the variables of the outer one, as when lengths
/// determine sizes and sizes determine masses. Derivatives follow by the chain rule, second
/// derivatives too if both maps have them. The composition has the inner map's variables; the outer
/// map's bounds are not imposed.
///
/// @throws InvalidInput if a map is null, or `inner` does not give as many numbers as `outer` takes
[[nodiscard]] DesignMapPointer compose(DesignMapPointer outer, DesignMapPointer inner);

}  // namespace hbar
