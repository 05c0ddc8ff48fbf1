#pragma once

#include <string>

#include "report.h"

namespace hbar::finger_reach {

/// The finger at its targets as an SVG picture, to scale: from the side, in the plane of its links,
/// which turns with the base; from above; and the tip's path at each target, enlarged.
[[nodiscard]] std::string picture_svg(const Reach& reach, const Outcome& outcome);

}  // namespace hbar::finger_reach
