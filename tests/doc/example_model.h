#pragma once

#include <string>

#include "hbar/hbar.h"

namespace hbar::testing {

/// The model of a scene in examples/scenes.
[[nodiscard]] inline Model example_model(const std::string& scene) {
  return scene::load_model(HBAR_SOURCE_DIR "/examples/scenes/" + scene).model;
}

}  // namespace hbar::testing
