#pragma once

#include <string>
#include <vector>

namespace hbar::solver_benchmark {

/// A table of costs: a row per matrix, a column per solver; infinite where a solver failed.
struct CostTable {
  std::vector<std::string> solvers;
  std::vector<std::vector<double>> costs;  ///< [matrix][solver], ≥ 0
};

/// A solver's line in a performance profile.
struct ProfileLine {
  std::string solver = {};
  /// Ratios to the best solver of each matrix, ascending; of matrices that it solved.
  std::vector<double> ratios = {};
  int matrices = 0;   ///< that some solver solved and this one was tried on
  int wins = 0;       ///< matrices on which it was the best
  double mean = 0.0;  ///< geometric mean of the ratios; 0 if it solved none

  /// Share of its matrices that it solves at most `ratio` times as slowly as the best.
  [[nodiscard]] double share(double ratio) const;
};

/// Performance profiles (E. D. Dolan, J. J. Moré, "Benchmarking optimization software with
/// performance profiles", 2002). A matrix that a solver was not tried on (a negative cost) does not
/// count for it.
[[nodiscard]] std::vector<ProfileLine> performance_profiles(const CostTable& table);

/// Geometric mean, over the matrices that some other solver solved, of a solver's cost over the
/// least of the others'; 0 if there is no such matrix.
[[nodiscard]] double mean_ratio_to_best_other(const CostTable& table, const std::string& solver);

}  // namespace hbar::solver_benchmark
