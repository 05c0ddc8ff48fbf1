#pragma once

#include "hbar/contact/contact_forces.h"
#include "hbar/core/model/model.h"
#include "hbar/solvers/newton/newton.h"
// planted: layer
#include "hbar/solvers/linear/klu.h"
// planted: layer
#include "hbar/adjoint/programs/load_problem.h"
// planted: layer
#include "hbar/core/scene/description.h"
