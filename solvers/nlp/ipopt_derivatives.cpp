#include "hbar/solvers/nlp/ipopt_derivatives.h"

#include <cstdlib>
#include <sstream>

#include "hbar/solvers/nlp/ipopt_run.h"

namespace hbar::solvers {

IpoptDerivativeTest test_derivatives_with_ipopt(Nlp& nlp, HessianKind second, double tolerance,
                                                double perturbation) {
  if (second == HessianKind::kGaussNewton) {
    throw InvalidInput(
        "test_derivatives_with_ipopt: a Gauss-Newton matrix is no derivative; expected kExact or "
        "kLimitedMemory");
  }
  const bool first_only = second == HessianKind::kLimitedMemory;
  IpoptOptions options;
  options.hessian = second;
  options.max_iterations = 0;
  options.string_options["derivative_test"] = first_only ? "first-order" : "second-order";
  options.number_options["derivative_test_tol"] = tolerance;
  options.number_options["derivative_test_perturbation"] = perturbation;
  // Ipopt would otherwise move the start by a random step.
  options.number_options["point_perturbation_radius"] = 0.0;
  std::ostringstream journal;
  const IpoptResult result = run_ipopt(nlp, options, &journal);

  const std::string text = journal.str();
  // Ipopt's last line before it begins to optimise.
  const std::string clean = "No errors detected by derivative checker.";
  const std::string counted = "Derivative checker detected ";
  std::size_t verdict = text.find(clean);
  IpoptDerivativeTest report;
  if (verdict == std::string::npos) {
    verdict = text.find(counted);
    if (verdict == std::string::npos) {
      throw EvaluationError(concat("test_derivatives_with_ipopt: no verdict: ", result.message));
    }
    report.errors = std::atoi(text.c_str() + verdict + counted.size());
  }
  report.text = text.substr(0, text.find('\n', verdict) + 1);
  return report;
}

}  // namespace hbar::solvers
