#pragma once

#include "hbar/core/model.h"
#include "hbar/scene/description.h"
// planted: third-party
#include <tinyxml2.h>
// planted: floor
#include "hbar/adjoint/rollout.h"
