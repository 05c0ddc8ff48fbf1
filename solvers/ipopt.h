#pragma once

// The component hbar::ipopt: Ipopt on any nonlinear program, and diagnosis of its results.

#include "hbar/solvers/nlp/diagnosis.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"
#include "hbar/solvers/nlp/sensitivity.h"
