#pragma once

#include "hbar/core/files/numbers.h"
#include "hbar/core/model/model.h"
// planted: third-party
#include <tinyxml2.h>
// planted: layer
#include "hbar/core/dynamics/motion.h"
// planted: layer
#include "hbar/adjoint/trajectory/rollout.h"
