#pragma once

#include <iosfwd>

namespace hbar::benchmarks {

/// The trajectory's linear system by block substitution, as two tables: a solution with H̄ against
/// reading H̄'s entries once from memory, and how a gradient by assembled matrices grows with the
/// number of steps at 7 coordinates, with what the matrices take. Times are of the processor, so
/// that other work on the machine counts little.
///
/// @param repetitions  of each measurement; the fastest counts
void write_system_ratios(int repetitions, std::ostream& out);

}  // namespace hbar::benchmarks
