#pragma once

// The component hbar::umfpack: make_umfpack, and solver_factory("umfpack").

#include "hbar/solvers/linear/umfpack.h"

namespace hbar::solvers::detail {
inline const bool kHasUmfpack = register_umfpack();
}  // namespace hbar::solvers::detail
