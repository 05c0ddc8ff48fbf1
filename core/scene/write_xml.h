#pragma once

#include <filesystem>
#include <string>

#include "hbar/core/scene/description.h"

namespace hbar::scene {

/// The scene file of a description: every attribute explicit, numbers with the fewest digits that
/// read back the same, so that reading it gives an equal description. Links are nested if their
/// order and depth allow it, and otherwise written flat with `parent`.
///
/// @throws InvalidInput if the description is not one the format allows (a name is missing, a
///         number not finite, a parent not before its child)
[[nodiscard]] std::string write_scene_text(const Description& description);

/// Writes that file atomically.
///
/// @throws InvalidInput as write_scene_text
/// @throws IoError      if it cannot be written; an old file stays unchanged
void write_scene(const std::filesystem::path& path, const Description& description);

}  // namespace hbar::scene
