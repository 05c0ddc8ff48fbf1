#pragma once

// The component hbar::nlopt: NLopt's methods on any nonlinear program.

#include "hbar/solvers/nlp/nlopt.h"
