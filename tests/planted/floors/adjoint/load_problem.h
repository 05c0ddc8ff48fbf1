#pragma once

// The composition root may.
#include "hbar/scene/description.h"
// planted: floor
#include "hbar/study/pareto.h"
#include "hbar/scene/description.h"
