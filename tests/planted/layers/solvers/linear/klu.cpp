#include <suitesparse/klu.h>

#include "hbar/core/base/error.h"
#include "hbar/core/base/scalar.h"
// planted: layer
#include "hbar/core/model/model.h"
// planted: layer
#include "hbar/adjoint/derivatives/linearization.h"
