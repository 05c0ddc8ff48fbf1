// How one compares solvers on the linear system of a trajectory:
//
//   cmake --build build/release --target solver_benchmark
//   build/release/examples/solver_benchmark/solver_benchmark
//
// prints, for the adjoint system of a chain of 7 joints and 1000 steps, what every solver of the
// suite takes to analyse, factorise and solve it, and how large its backward error is. The command
// `hbar solvers` does it for whole families of systems.
#include <chrono>
#include <cstdio>

#include "examples/solver_benchmark/families.h"
#include "hbar/adjoint/systems/trajectory_system.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/linear/accuracy.h"
#include "hbar/suite.h"

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Solves the system by one solver and prints a line.
void compare(const hbar::solvers::SolverEntry& entry, const hbar::TrajectorySystem& system) {
  using hbar::solvers::System;
  using clock = std::chrono::steady_clock;
  const auto solver = hbar::solvers::make_solver(entry.name, system.options, system.A);
  solver->name_unknowns(system.name_of_unknown);
  Eigen::MatrixXd x(system.A.rows(), 1);
  try {
    const auto start = clock::now();
    solver->analyze(system.A);
    const double analyse = milliseconds_since(start);
    solver->factorize(system.A);
    const double factorise = milliseconds_since(start) - analyse;
    solver->solve(system.b, x);
    const double solve = milliseconds_since(start) - analyse - factorise;
    std::printf(
        "%-20s %8.2f %9.2f %8.2f %11.0f   %.1e\n", entry.name.c_str(), analyse, factorise, solve,
        solver->factor_info().entries,
        hbar::solvers::normwise_backward_error(system.A, System::kPlain, x.col(0), system.b));
  } catch (const hbar::NumericalFailure& error) {
    std::printf("%-20s %s\n", entry.name.c_str(), error.what());
  }
}

}  // namespace

int main() {
  // 1. A motion: a chain of 7 joints, a thousand steps of BDF2.
  const hbar::solver_benchmark::Family& chain = hbar::solver_benchmark::find_family("chain");
  const hbar::Model model = hbar::solver_benchmark::make_model(chain, 7);
  hbar::SimulationOptions options;
  options.integrator = "bdf2";
  options.h = chain.h;
  options.steps = 1000;
  hbar::Horizon horizon(model, hbar::ParameterSet::named(model, {}), options);
  hbar::Inputs inputs = horizon.nominal_inputs();
  hbar::solver_benchmark::set_gentle_motion(chain, model, inputs);
  const hbar::Trajectory trajectory = simulate(horizon, inputs).trajectory();

  // 2. Its adjoint system, and the solver that is picked for it.
  const hbar::TrajectorySystem system =
      hbar::assemble_system(hbar::SystemKind::kAdjoint, horizon, trajectory);
  const auto choice = hbar::solvers::choose_solver(system.options, system.A);
  std::printf("%d rows, %d entries; auto takes %s: %s\n", static_cast<int>(system.A.rows()),
              static_cast<int>(system.A.nonZeros()), choice.name.c_str(), choice.reason.c_str());

  // 3. Every solver that is meant for a system of this structure.
  std::printf("%-20s %8s %9s %8s %11s   %s\n", "ms", "analyse", "factorise", "solve", "entries",
              "backward error");
  for (const hbar::solvers::SolverEntry& entry : hbar::solvers::available_solvers()) {
    if (entry.claims(system.options.structure)) {
      compare(entry, system);
    }
  }
  return 0;
}
