#pragma once

#include <vector>

#include "hbar/core/model/measurement.h"

namespace hbar {

/// What a measured row may change with at its instant, parameters aside; each ascending.
struct MeasuredReads {
  std::vector<int> q;         ///< coordinates
  std::vector<int> qdot;      ///< coordinates whose rates are read
  std::vector<int> controls;  ///< of the step that ends
};

/// What each row of a measurement may change with.
[[nodiscard]] std::vector<MeasuredReads> measured_reads(const Model& model,
                                                        const Measurement& measurement);

}  // namespace hbar
