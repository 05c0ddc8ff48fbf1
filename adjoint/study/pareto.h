#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::study {

/// The result of minimising one weighted sum of two objectives.
struct WeightedOptimum {
  bool converged = false;
  double f1 = 0.0;                      ///< first objective; smaller is better
  double f2 = 0.0;                      ///< second objective; smaller is better
  solvers::PrimalDualPoint point = {};  ///< warm start for the next weight
  std::string message = {};             ///< how it ended
};

/// Minimises weight · f1 + (1 − weight) · f2, or anything else that a weight from 0 to 1 selects.
///
/// @param warm  the neighbour's solution; null: start cold
using WeightedSolve =
    std::function<WeightedOptimum(double weight, const solvers::PrimalDualPoint* warm)>;

/// A point of a front.
struct ParetoPoint {
  double weight = 0.0;
  WeightedOptimum optimum = {};
  bool dominated = false;  ///< another one is as good in both objectives and better in one
};

/// n weights from 0 to 1, equally spaced.
///
/// @throws InvalidInput if n is below 2
[[nodiscard]] std::vector<double> equal_weights(int n);

/// Traces the front of two objectives, starting each solve from its neighbour's solution.
///
/// A solve that does not converge, returns numbers that are not finite or throws a NumericalFailure
/// is kept as a point that did not converge, with its message; the next one starts from the last
/// that converged.
///
/// @param weights  in [0, 1], in the order in which they are solved; neighbours should be near
/// @param solve    called once per weight
/// @returns one point per weight: those that converged by ascending f1 (then f2, then weight), then
///   the others by weight; a point that did not converge neither dominates nor is dominated
/// @throws InvalidInput if a weight is outside [0, 1] or there is none
[[nodiscard]] std::vector<ParetoPoint> pareto_sweep(const std::vector<double>& weights,
                                                    const WeightedSolve& solve);

}  // namespace hbar::study
