#pragma once

#include <memory>

#include "hbar/solvers/linear/solver_options.h"

namespace hbar::solvers {

/// Dense LU of a block-banded matrix, a block column at a time: partial pivoting among all rows of
/// the block column from its diagonal block down, so that every regular matrix can be factorised,
/// and the upper band grows by the width of the lower one. The band follows the outline of the
/// matrix, blocks may differ in size, and blocks of zeros above the diagonal cost storage but no
/// work.
///
/// @param options  block_sizes: rows of each diagonal block, or none for blocks of one size that
///                 suits the bandwidth  [blocks]
/// @throws InvalidInput if a block size is not positive, or ordering is not kDefault or kNatural
/// analyze() throws InvalidInput if the block sizes do not add up to the rows of the matrix, or the
/// factors would take more than kMaxBandBytes (band.h).
[[nodiscard]] std::unique_ptr<LinearSolver> make_block_banded(const SolverOptions& options = {});

}  // namespace hbar::solvers
