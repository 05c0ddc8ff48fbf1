#pragma once

#include "task.h"

namespace hbar::manipulation {

/// A finger turns a box on the ground by 90° about the vertical.
[[nodiscard]] Task rotate_box();

/// The same finger flips a box over its edge.
[[nodiscard]] Task flip_box();

/// Two fingers bring two boxes together, aligned, with contacts that stiffen from stage to stage.
[[nodiscard]] Task assemble();

}  // namespace hbar::manipulation
