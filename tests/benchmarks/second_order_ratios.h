#pragma once

#include <iosfwd>

namespace hbar::benchmarks {

/// Writes what a Hessian-vector product costs, in gradients of the same trajectory: alone, and with
/// what setting its point costs shared by as many products as there are coordinates.
///
/// @param repetitions  the fastest of so many counts
void write_second_order_ratios(int repetitions, std::ostream& out);

}  // namespace hbar::benchmarks
