#pragma once

#include "hbar/adjoint/terms/objective.h"

namespace hbar {

/// What has a gradient: a simulation, an objective of it, and the inputs where both are taken.
struct Problem {
  Simulator simulator;
  Objective objective;
  Inputs inputs;
};

}  // namespace hbar
