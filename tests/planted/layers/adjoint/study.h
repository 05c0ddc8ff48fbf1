#pragma once

// The header of a component may include its folder, as other users may not.
#include "hbar/adjoint/study/pareto.h"
// planted: layer
#include "hbar/ipopt.h"
