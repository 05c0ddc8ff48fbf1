#pragma once

#include <span>

#include "hbar/core/scene/vocabulary.h"

namespace hbar::scene {

/// The attribute tables of the larger elements, in their own file for length.
[[nodiscard]] std::span<const AttributeInfo> joint_attributes();
[[nodiscard]] std::span<const AttributeInfo> body_attributes();

}  // namespace hbar::scene
