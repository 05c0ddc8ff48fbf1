#pragma once

#include "arguments.h"

namespace hbar::tool {

/// The problem given by the command line: the scene, with initial state and controls set.
///
/// @throws ProgramError  kUsage for options that do not suit the scene, kBadScene for the scene and
///                    the control file, kInputOutput for files that cannot be read
[[nodiscard]] LoadedProblem load(const Arguments& arguments);

}  // namespace hbar::tool
