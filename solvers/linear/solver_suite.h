#pragma once

namespace hbar::solvers {

/// Adds the suite's solvers to those found by name: block_banded, eigen_sparse_lu, and those of
/// umfpack, the solvers of CHOLMOD, spqr, mumps and lapack_band that were available when
/// hbar::suite was built. Including "hbar/suite.h" calls it.
///
/// @returns true
bool register_suite();

}  // namespace hbar::solvers
