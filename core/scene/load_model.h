#pragma once

#include <atomic>
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
/// @param stop  as build_model's
/// @throws IoError, InvalidInput, Interrupted  as they do
[[nodiscard]] LoadedModel load_model(const std::filesystem::path& path,
                                     const std::atomic<bool>* stop = nullptr);

}  // namespace hbar::scene
