#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/terms/objective.h"

namespace hbar {

using TermPointer = std::shared_ptr<const ObjectiveTerm>;

/// A weight ≥ 0 for each step of a sum over steps.
///
/// Entry k − 1 is that of step k = 1 … N, which ends at t_k = k h and whose controls are u_{k−1}.
struct StepWeights {
  Eigen::VectorXd each;  ///< empty: ones                                            [N or 0]

  /// Weights as a function of the time at the end of each step, w_k = weight(k h).
  ///
  /// @param steps   N
  /// @param h       time step
  /// @param weight  of a time; `[](double t) { return t; }` gives more weight to what happens late
  [[nodiscard]] static StepWeights over_time(int steps, double h,
                                             const std::function<double(double)>& weight);
  /// The weight of step k = 1 … N.
  [[nodiscard]] double of(Eigen::Index k) const { return each.size() == 0 ? 1.0 : each[k - 1]; }
  /// @throws InvalidInput naming the term if an entry is negative or not finite
  void check(const std::string& term) const;
};

/// Which rows of a member a sum reads if it does not list them.
enum class RowChoice {
  kAll,
  kVariables,  ///< of kMeasured: those of the end effectors
  kTactile,    ///< of kMeasured: those of the tactile sensors
  kDeclared    ///< of kMeasured: those of SimulationOptions::measurements
};

/// Which numbers a term adds up, and how much each counts.
struct StepSum {
  ValueField field = ValueField::kQ;  ///< a member with steps: not kP
  std::vector<int> rows = {};         ///< of the member; empty: as `choice` says
  RowChoice choice = RowChoice::kAll;
  Eigen::MatrixXd target = {};  ///< empty: zeros                        [rows x N or 1]
  double weight = 1.0;
  StepWeights steps = {};
  bool final_only = false;  ///< the last column alone instead of steps 1 … N
  bool times_h = false;     ///< an integral over time, not a sum
};

/// A function of one number: its value and its first two derivatives.
struct Jet {
  double value = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

/// Σ weight φ(x − target) over the numbers x of some sums: a term with diagonal second partials.
///
/// @param name    for messages
/// @param sums    no number in more than one of them
/// @param phi     φ
/// @param linear  φ'' is zero everywhere: no second partials
/// @throws InvalidInput if a weight is not finite; later, if targets, weights or rows do not have
///         the values' shape
[[nodiscard]] TermPointer separable_term(std::string name, std::vector<StepSum> sums,
                                         std::function<Jet(double)> phi, bool linear = false);

}  // namespace hbar
