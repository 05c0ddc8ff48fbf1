#pragma once

#include <string>
#include <vector>

namespace hbar::solver_benchmark {

/// Along what matrices grow.
enum class ScalingAxis {
  kSteps,  ///< T, of one model
  kDof     ///< n, of one family and one T
};

/// "steps" or "dof".
[[nodiscard]] std::string name_of(ScalingAxis axis);

/// How one solver's costs grow along an axis.
struct ScalingLine {
  ScalingAxis axis = ScalingAxis::kSteps;
  std::string group;   ///< what does not change: "chain7_bdf2_adjoint", "chain_bdf2_100_kkt"
  std::string solver;  ///< see column_name
  std::vector<double> at = {};      ///< T or n, ascending; at least two
  std::vector<double> time = {};    ///< Measurement::total() there, s
  std::vector<double> memory = {};  ///< Measurement::bytes there

  [[nodiscard]] double time_slope() const;    ///< exponent of the power law through `time`
  [[nodiscard]] double memory_slope() const;  ///< the same of `memory`
};

/// Exponent p of the power law c·xᵖ that fits y best: least squares of log y over log x.
///
/// @param x, y  positive, of equal size; x not all the same
[[nodiscard]] double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace hbar::solver_benchmark
