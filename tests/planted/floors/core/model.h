#pragma once

#include <Eigen/Core>
#include <vector>

#include "hbar/core/scalar.h"
// planted: floor
#include "hbar/scene/description.h"
// planted: floor
#include "hbar/solvers/newton.h"
// planted: third-party
#include <tinyxml2.h>
// planted: third-party
#include <fstream>
// planted: third-party
#include <somewhere/unknown.h>
// planted: floor
#include "model.h"
