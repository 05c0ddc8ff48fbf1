#pragma once

#include "hbar/adjoint/terms/objective.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// Everything a gradient needs: a simulation, an objective, and the inputs at which both are
/// evaluated.
struct Problem {
  Horizon horizon;
  Objective objective;
  Inputs inputs;
};

}  // namespace hbar
