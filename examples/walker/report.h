#pragma once

#include <memory>
#include <string>
#include <vector>

#include "examples/common/optimise.h"
#include "gait.h"

namespace hbar::walker {

/// One optimisation and the gait it found.
struct Stage {
  std::unique_ptr<Transcription> program;
  example::Optimised outcome;
  Gait gait;
};

/// A readable summary.
///
/// @param stages  in the order in which they were solved: some gait first, the optimum last
[[nodiscard]] std::string summary(const Plan& plan, const std::vector<Stage>& stages);

/// The same as data, numbers at full precision.
[[nodiscard]] std::string result_json(const Plan& plan, const std::vector<Stage>& stages);

}  // namespace hbar::walker
