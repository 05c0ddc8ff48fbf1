#pragma once

#include <string>
#include <vector>

#include "examples/common/optimise.h"
#include "hbar/adjoint/study/pareto.h"
#include "reach.h"

namespace hbar::finger_reach {

/// One way to solve the problem, and how it went.
struct Way {
  Formulation formulation = Formulation::kShooting;
  solvers::HessianKind hessian = solvers::HessianKind::kExact;
  Eigen::Index variables = 0;
  Eigen::Index constraints = 0;
  solvers::IpoptResult result;
  Eigen::VectorXd head;  ///< design and controls, which every formulation has
};

/// Solves with every formulation and every Hessian from the same start, with BDF2 restarting in
/// each segment in every formulation, so that all of them have the same optimum.
///
/// @param arguments  its segments and max_iterations are used; prints a line per way
[[nodiscard]] std::vector<Way> solve_every_way(const std::filesystem::path& scene, int steps,
                                               const example::OptimiseArguments& arguments);

/// A line per way, and how far the optima are from the first of those that converged.
[[nodiscard]] std::string ways_table(const std::vector<Way>& ways);

/// A point of the front of effort and mass.
struct FrontPoint {
  study::ParetoPoint point;  ///< f1 the effort, f2 the phalanges' mass in kg
  Eigen::VectorXd design;    ///<                                                          [6]
};

/// Takes the front as far as it is known.
using SaveFront = std::function<void(const std::vector<FrontPoint>&)>;

/// The least weight · effort + (1 − weight) · mass / 100 g, each from its neighbour's solution.
///
/// @param save  called after each point
[[nodiscard]] std::vector<FrontPoint> front_of_mass(const std::filesystem::path& scene, int steps,
                                                    const example::OptimiseArguments& arguments,
                                                    const std::vector<double>& weights,
                                                    const SaveFront& save);
[[nodiscard]] std::string front_csv(const std::vector<FrontPoint>& front);
[[nodiscard]] std::string front_table(const std::vector<FrontPoint>& front);

/// Sensitivity of the optimum to given values: of effort and design to a payload at the tip, of
/// effort to the mass limit.
///
/// @param reach    with a payload, which may be 0
/// @param optimum  of the exact Hessian's program, converged
/// @throws NumericalFailure as sensitivity_of_optimum
[[nodiscard]] std::string sensitivity_table(const Reach& reach,
                                            const solvers::IpoptResult& optimum);

}  // namespace hbar::finger_reach
