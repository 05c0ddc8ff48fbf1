#pragma once

#include <string>

#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"

namespace hbar::scene {

/// What build_model says when it refuses a scene; "was built" if it does not.
[[nodiscard]] inline std::string refusal(const Scene& scene) {
  try {
    static_cast<void>(build_model(scene));
  } catch (const Error& error) {
    return error.what();
  }
  return "was built";
}

}  // namespace hbar::scene
