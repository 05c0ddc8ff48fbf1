#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hbar {

/// One implicit stage of an integrator: how the rates at its end follow from the states.
///
/// With h q̇ = Σ C_j q_j and h q̈ = Σ C_j q̇_j over the stage itself, the earlier stages of its
/// step and the ends of earlier steps (doc/integrators.md). The weights sum to zero. The stage's
/// residual is g = M Δ − c f with Δ = c q̈ and c = h² / C_own².
struct IntegratorStage {
  double time = 1.0;              ///< within the step, as a share of h
  double own = 1.0;               ///< weight on the stage itself
  std::vector<double> earlier;    ///< weights on this step's earlier stages, in order
  std::vector<double> step_ends;  ///< weights on the step's start, and on starts before it
};

/// An integrator: a row of the table. A step consists of its stages in order; the last one ends it.
struct Integrator {
  std::string name;
  int order = 1;  ///< of convergence
  std::vector<IntegratorStage> stages;
  int history = 1;      ///< step starts it looks back on, at the same h
  std::string starter;  ///< method for the steps before that history exists
};

/// The table: bdf1 (22), sdirk2 (24), (25), bdf2 (28) started by sdirk2.
[[nodiscard]] const std::vector<Integrator>& integrators();

/// The row of that name, upper or lower case.
/// @throws InvalidInput listing the known names
[[nodiscard]] const Integrator& find_integrator(std::string_view name);

}  // namespace hbar
