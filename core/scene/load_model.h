#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hbar/core/model/model.h"

namespace hbar::scene {

/// A scene file's model.
struct LoadedModel {
  Model model;
  std::vector<std::string> notices;  ///< what the user should know, each `file:line: ...`
};

/// read_scene and build_model in one.
/// @throws IoError, InvalidInput  as they do
[[nodiscard]] LoadedModel load_model(const std::filesystem::path& path);

}  // namespace hbar::scene
