#pragma once

#include <iosfwd>

namespace hbar::benchmarks {

/// Measures hbar and MuJoCo in turn, so that drift of the machine cancels, and writes the medians
/// of times and of ratios as tables.
///
/// @param repetitions  of each measurement; the median is taken over them
void write_ratios(int repetitions, std::ostream& out);

/// The last of these tables alone: a grasp, and contact's share of its cost.
void write_grasp_ratios(int repetitions, std::ostream& out);

}  // namespace hbar::benchmarks
