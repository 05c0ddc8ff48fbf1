#pragma once

// The component hbar::suite: every linear solver by name, and measures for comparing them.

#include "hbar/solvers/linear/accuracy.h"
#include "hbar/solvers/linear/solver_catalogue.h"
#include "hbar/solvers/linear/solver_choice.h"
#include "hbar/solvers/linear/solver_suite.h"

namespace hbar::solvers::detail {
inline const bool kHasSuite = register_suite();
}  // namespace hbar::solvers::detail
