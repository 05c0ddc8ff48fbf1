#include "hbar/adjoint/study/pareto.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "hbar/core/base/error.h"

namespace hbar::study {
namespace {

WeightedOptimum solve_or_tell(const WeightedSolve& solve, double weight,
                              const solvers::PrimalDualPoint* warm) {
  WeightedOptimum optimum;
  try {
    optimum = solve(weight, warm);
  } catch (const NumericalFailure& failure) {
    optimum.message = failure.what();
  }
  if (!std::isfinite(optimum.f1) || !std::isfinite(optimum.f2)) {
    optimum.message = concat("an objective is not finite; ", optimum.message);
    optimum.converged = false;
    optimum.f1 = 0.0;
    optimum.f2 = 0.0;
  }
  return optimum;
}

bool dominates(const WeightedOptimum& a, const WeightedOptimum& b) {
  return a.f1 <= b.f1 && a.f2 <= b.f2 && (a.f1 < b.f1 || a.f2 < b.f2);
}

bool comes_before(const ParetoPoint& a, const ParetoPoint& b) {
  const auto key = [](const ParetoPoint& point) {
    const WeightedOptimum& optimum = point.optimum;
    return optimum.converged ? std::tuple(0, optimum.f1, optimum.f2, point.weight)
                             : std::tuple(1, 0.0, 0.0, point.weight);
  };
  return key(a) < key(b);
}

/// Fronts have tens of points: every pair is compared.
void mark_dominated(std::vector<ParetoPoint>& points) {
  for (ParetoPoint& point : points) {
    if (!point.optimum.converged) {
      continue;
    }
    point.dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      return other.optimum.converged && dominates(other.optimum, point.optimum);
    });
  }
}

}  // namespace

std::vector<double> equal_weights(int n) {
  if (n < 2) {
    throw InvalidInput(concat("equal_weights: ", n, " weights; at least 2 are needed"));
  }
  std::vector<double> weights;
  for (int i = 0; i < n; ++i) {
    weights.push_back(static_cast<double>(i) / (n - 1));
  }
  return weights;
}

std::vector<ParetoPoint> pareto_sweep(const std::vector<double>& weights,
                                      const WeightedSolve& solve) {
  if (weights.empty()) {
    throw InvalidInput("pareto_sweep: there are no weights");
  }
  for (const double weight : weights) {
    if (!(weight >= 0.0 && weight <= 1.0)) {
      throw InvalidInput(concat("pareto_sweep: weight ", weight, " is outside [0, 1]"));
    }
  }
  std::vector<ParetoPoint> points;
  solvers::PrimalDualPoint last;
  const solvers::PrimalDualPoint* warm = nullptr;
  for (const double weight : weights) {
    points.push_back({.weight = weight, .optimum = solve_or_tell(solve, weight, warm)});
    if (points.back().optimum.converged) {
      last = points.back().optimum.point;
      warm = &last;
    }
  }
  std::sort(points.begin(), points.end(), comes_before);
  mark_dominated(points);
  return points;
}

}  // namespace hbar::study
