#pragma once

#include "hbar/adjoint/terms/objective.h"
#include "hbar/adjoint/trajectory/horizon.h"

namespace hbar {

/// What has a gradient: a simulation, an objective of it, and the inputs where both are taken.
struct Problem {
  Horizon horizon;
  Objective objective;
  Inputs inputs;
};

}  // namespace hbar
