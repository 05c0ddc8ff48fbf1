#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/terms/problem.h"

namespace hbar {

/// The entries of the flat inputs (p, then u step by step, q₀, q̇₀) that belong to one class, and
/// how far each may be moved to see what it does: a typical size, in the problem's own lengths,
/// times and forces.
struct ProbedClass {
  std::string name;  ///< a parameter kind, "controls", "initial position", "initial velocity"
  std::vector<Eigen::Index> entries;
  std::vector<double> scales;
};

/// Every class of inputs of which the problem has one.
[[nodiscard]] std::vector<ProbedClass> probed_classes(const Problem& problem);

}  // namespace hbar
