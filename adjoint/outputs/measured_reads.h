#pragma once

#include <vector>

#include "hbar/core/model/measurement.h"

namespace hbar {

/// What a measured row can depend on at its instant, apart from parameters; each list ascending.
struct MeasuredReads {
  std::vector<int> q;         ///< coordinates
  std::vector<int> qdot;      ///< coordinates whose rates are read
  std::vector<int> controls;  ///< of the step that ends
};

/// What each row of a measurement can depend on.
[[nodiscard]] std::vector<MeasuredReads> measured_reads(const Model& model,
                                                        const Measurement& measurement);

}  // namespace hbar
