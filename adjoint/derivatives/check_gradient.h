#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/terms/problem.h"

namespace hbar {

/// How check_gradient tests a gradient, and what it accepts.
struct GradientCheckOptions {
  int directions = 3;              ///< random directions per class
  unsigned seed = 1;               ///< of the directions
  double difference_bound = 1e-6;  ///< on the gap to central differences
  double slope_tolerance = 0.1;    ///< how far the remainder's slope may fall short of 2
  double dot_bound = 1e-12;        ///< on the adjoint-tangent gap
};

/// One class of inputs, checked along its own random directions.
struct GradientCheckRow {
  std::string name;             ///< a parameter kind, "controls", "initial position", …
  int size = 0;                 ///< scalars in the class
  double difference_gap = 0.0;  ///< worst |central difference − g·d| / (‖g‖‖d‖), best step of many
  double taylor_slope =
      0.0;  ///< of log |Ψ(x+εd) − Ψ(x) − ε g·d| over log ε; least of all directions
  bool remainder_vanishes = false;  ///< Ψ is affine along the class to rounding: no slope
  /// Whether differences say anything: along no direction, on neither side, does the smooth piece
  /// of Ψ reach as far as rounding allows if not. The dot product is all there is then.
  bool resolved = true;
  double dot_gap = 0.0;  ///< worst |g·d − ∂Ψ·δ(q̄, q̇̄, v̄, u, p)| / (‖g‖‖d‖)
  bool passed = false;
};

/// What check_gradient found.
struct GradientCheckReport {
  std::vector<GradientCheckRow> rows;

  /// Whether nothing contradicts the gradient.
  [[nodiscard]] bool passed() const;
  /// Names of the classes that no difference confirms, either.
  [[nodiscard]] std::vector<std::string> unresolved() const;
  /// A readable table, one line per class.
  [[nodiscard]] std::string table() const;
};

/// Self-check: for each class of inputs, compares the adjoint gradient with central differences of
/// whole simulations, the order of the Taylor remainder, and tangents from an independent assembly.
///
/// Directions are as large as the problem's own lengths, times and forces, parameters stay within
/// their bounds, and differences on the smooth piece of Ψ: central where it reaches to both sides,
/// else one-sided, else none.
///
/// Tightens the Newton tolerance for it. Costs about forty simulations per class and direction.
///
/// @throws NumericalFailure if the nominal simulation does not converge
[[nodiscard]] GradientCheckReport check_gradient(const Problem& problem,
                                                 const GradientCheckOptions& options = {});

}  // namespace hbar
