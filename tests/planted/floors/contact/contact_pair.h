#pragma once

#include "hbar/core/force.h"
#include "hbar/scene/description.h"
// planted: floor
#include "hbar/solvers/newton.h"
