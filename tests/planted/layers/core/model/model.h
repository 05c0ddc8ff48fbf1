#pragma once

#include <Eigen/Core>
#include <vector>

#include "hbar/core/base/scalar.h"
// planted: layer
#include "hbar/core/scene/description.h"
// planted: layer
#include "hbar/solvers/newton/newton.h"
// planted: third-party
#include <tinyxml2.h>
// planted: third-party
#include <fstream>
// planted: third-party
#include <somewhere/unknown.h>
// planted: layer
#include "model.h"
