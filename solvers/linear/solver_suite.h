#pragma once

namespace hbar::solvers {

/// Adds the suite's solvers to those that are found by their names: block_banded, eigen_sparse_lu,
/// and what was there when hbar::suite was built of umfpack, the solvers of CHOLMOD, spqr, mumps
/// and lapack_band. Including "hbar/suite.h" calls it.
///
/// @returns true
bool register_suite();

}  // namespace hbar::solvers
