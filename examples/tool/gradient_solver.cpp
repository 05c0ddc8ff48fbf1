#include "gradient_solver.h"

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#ifdef HBAR_HAVE_SUITE
#include "hbar/solvers/linear/solver_suite.h"
#endif

namespace hbar::tool {

std::vector<std::string> linear_solver_names() {
  std::vector<std::string> names = {"sweep"};
#ifdef HBAR_HAVE_SUITE
  names.emplace_back("auto");
  for (const solvers::SolverEntry& entry : solvers::solver_suite()) {
    if (entry.claims(solvers::Structure::kBlockTriangular)) {
      names.push_back(entry.name);
    }
  }
#endif
  return names;
}

Gradient gradient_of(LoadedProblem& loaded, const Trajectory& trajectory) {
  Problem& problem = loaded.problem;
  if (loaded.linear_solver == "sweep") {
    return gradient(problem.horizon, trajectory, problem.objective);
  }
#ifdef HBAR_HAVE_SUITE
  AssembledAdjoint adjoint(problem.horizon, solvers::solver_factory(loaded.linear_solver));
  return adjoint.gradient(trajectory, problem.objective);
#else
  throw InvalidInput(concat("linear_solver \"", loaded.linear_solver,
                            "\": this hbar was built without hbar::suite; take \"sweep\""));
#endif
}

}  // namespace hbar::tool
