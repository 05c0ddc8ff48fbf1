#pragma once

#include "hbar/core/model.h"
#include "hbar/solvers/newton.h"
// planted: floor
#include "hbar/scene/description.h"
// planted: floor
#include "hbar/scene/description.h"
