#pragma once

// The composition root may.
#include "hbar/core/scene/description.h"
// planted: layer
#include "hbar/adjoint/study/pareto.h"
