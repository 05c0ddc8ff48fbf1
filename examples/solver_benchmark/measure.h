#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "cases.h"

namespace hbar::solver_benchmark {

/// Which time is measured.
enum class Clock {
  kWall,  ///< what passes
  kCpu    ///< what the process computes, all threads together: steadier on a machine that is shared
};

/// How to measure.
struct MeasureOptions {
  Clock clock = Clock::kWall;
  int repeat = 3;            ///< at least so often, of which the fastest counts; ≥ 1
  double least_time = 2e-4;  ///< s; what is shorter is repeated until so much has passed
  int rhs = 16;              ///< right-hand sides solved at once, ≥ 1
};

/// Data of a matrix, and the reference solution.
struct Reference {
  Eigen::VectorXd x;                ///< refined beyond working precision; empty if there is none
  std::optional<double> condition;  ///< estimate of ‖A‖₁ ‖A⁻¹‖₁
  std::string failure;              ///< why there is no x; else empty
  bool out_of_memory = false;       ///< whether that is why
};

/// One solver on one matrix. Times are in seconds of MeasureOptions::clock.
struct Measurement {
  std::string solver;                ///< as asked for: "auto", "klu", …
  std::string ordering;              ///< as asked for
  std::string chosen;                ///< by "auto": solver and, if it is not the default, ordering
  std::string failure;               ///< why it did not solve the system; else empty, and:
  double analyse = 0.0;              ///< the solver is made and studies the pattern
  double factorise = 0.0;            ///< for the first time after that
  double refactorise = 0.0;          ///< other values, same pattern
  double solve = 0.0;                ///< A x = b
  double solve_transposed = 0.0;     ///< Aᵀ x = b
  double solve_many = 0.0;           ///< A X = B with MeasureOptions::rhs columns
  double entries = 0.0;              ///< of the factors
  double fill = 0.0;                 ///< entries over those of A
  double bytes = 0.0;                ///< of factors and workspace
  std::optional<double> flops;       ///< of the factorisation
  double backward_error = 0.0;       ///< normwise, of A x = b
  double componentwise_error = 0.0;  ///< componentwise backward error, of A x = b
  double transposed_error = 0.0;     ///< normwise backward error, of Aᵀ x = b
  std::optional<double> forward_error;  ///< ‖x − reference‖∞ / ‖reference‖∞

  [[nodiscard]] bool solved() const { return failure.empty(); }
  /// analyse + factorise + solve: the cost of one new system.
  [[nodiscard]] double total() const { return analyse + factorise + solve; }
};

/// Solves by KLU and refines; estimates the condition unless the matrix came with it.
[[nodiscard]] Reference find_reference(const BenchmarkMatrix& matrix);

/// Measures a solver. A refusal by the solver is not thrown but reported in Measurement::failure.
///
/// @param solver  a name of available_solvers(), or "auto"
[[nodiscard]] Measurement measure(const BenchmarkMatrix& matrix, const Reference& reference,
                                  const std::string& solver, solvers::Ordering ordering,
                                  const MeasureOptions& options);

}  // namespace hbar::solver_benchmark
