#pragma once

#include "hbar/adjoint/programs/transcription.h"
#include "hbar/core/scene/description.h"
// planted: layer
#include "hbar/adjoint/study/pareto.h"
