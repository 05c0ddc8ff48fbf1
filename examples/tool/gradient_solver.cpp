#include "gradient_solver.h"

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/solvers/linear/solver_catalogue.h"
#ifdef HBAR_HAVE_SUITE
#include "hbar/suite.h"
#endif

namespace hbar::tool {

std::vector<std::string> linear_solver_names() {
  std::vector<std::string> names = {"sweep", "auto"};
  for (const solvers::SolverEntry& entry : solvers::available_solvers()) {
    if (entry.claims(solvers::Structure::kBlockTriangular)) {
      names.push_back(entry.name);
    }
  }
  return names;
}

Gradient gradient_of(const LoadedProblem& loaded, const Trajectory& trajectory) {
  const Problem& problem = loaded.problem;
  if (loaded.linear_solver == "sweep") {
    return gradient(problem.horizon, trajectory, problem.objective);
  }
  return gradient(problem.horizon, trajectory, problem.objective,
                  solver_factory(loaded.linear_solver));
}

}  // namespace hbar::tool
