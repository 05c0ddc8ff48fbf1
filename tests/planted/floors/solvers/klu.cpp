#include <suitesparse/klu.h>

#include "hbar/core/error.h"
#include "hbar/core/scalar.h"
// planted: floor
#include "hbar/core/model.h"
// planted: floor
#include "hbar/adjoint/linearization.h"
