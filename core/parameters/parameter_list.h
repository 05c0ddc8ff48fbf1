#pragma once

#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// Every scalar that can be free in a model, in the order of ParameterKind, then of links (motors,
/// contacts), then of components; mass and inertia, stiffness and damping, P and D stand together
/// by link. Contact points and scales are listed of bodies whose points a contact tests, and of
/// those whose design mask asks for them.
[[nodiscard]] std::vector<Parameter> list_parameters(const Model& model);

/// The bit of a link's design mask that selects a kind; 0 where none does.
[[nodiscard]] unsigned mask_bit(ParameterKind kind);

}  // namespace hbar
