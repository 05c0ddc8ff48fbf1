#pragma once

#include <string>

#include "hbar/solvers/nlp/nlp.h"

namespace hbar::solvers {

/// The findings of Ipopt's own derivative checker.
struct IpoptDerivativeTest {
  int errors = 0;    ///< derivatives that differ from differences by more than the tolerance
  std::string text;  ///< Ipopt's report, a line for each error: indices count from 0, numbers are
                     ///< in units of the scales
  [[nodiscard]] bool passed() const { return errors == 0; }
};

/// Lets Ipopt compare a program's derivatives with one-sided differences at its start: a second
/// opinion from independent code; check_gradients and check_hessian are more accurate.
///
/// @param nlp           the program; it is evaluated once per variable, and once more per variable
///                      and constraint for the Hessian
/// @param second        kExact: second derivatives too; kLimitedMemory: first derivatives only
/// @param tolerance     relative error that counts, > 0
/// @param perturbation  relative step of the differences, > 0
/// @throws InvalidInput if the program is inconsistent, second is kGaussNewton (not the second
///   derivative of any function), or tolerance or perturbation is not positive
/// @throws EvaluationError if the program cannot be evaluated at or near its start
/// @throws whatever the program throws
[[nodiscard]] IpoptDerivativeTest test_derivatives_with_ipopt(
    Nlp& nlp, HessianKind second = HessianKind::kLimitedMemory, double tolerance = 1e-4,
    double perturbation = 1e-8);

}  // namespace hbar::solvers
