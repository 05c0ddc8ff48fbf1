#include "tests/benchmarks/system_ratios.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <limits>
#include <ostream>

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/solvers/linear/block_substitution.h"
#include "tests/benchmarks/hinges.h"
#include "tests/support/random.h"

namespace hbar::benchmarks {
namespace {

using hbar::testing::Random;

/// Seconds of processor time that a work takes, the fastest of several.
template <typename Work>
double fastest(int repetitions, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    work();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    best = std::min(best, seconds);
  }
  return best;
}

struct Motion {
  Horizon horizon;
  Trajectory trajectory;
};

/// A hanging chain that swings.
Motion swinging_chain(int n, const std::string& integrator, int steps) {
  Model model = build_model(serial_chain(n));
  ParameterSet parameters = ParameterSet::all(model);
  Horizon horizon(std::move(model), std::move(parameters),
                  {.integrator = integrator, .h = 0.005, .steps = steps});
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 = Random(2).vector(n, 1.0 / std::sqrt(static_cast<double>(n)));
  Trajectory trajectory = simulate(horizon, inputs).trajectory();
  return {std::move(horizon), std::move(trajectory)};
}

void write_streaming(int repetitions, std::ostream& out) {
  out << "H of a chain by block substitution, against reading its entries once\n"
      << "   n  method  steps     MB   read ms  factorise   solve  transposed   solve/read  "
         "transposed/read\n";
  for (const int n : {16, 32, 64}) {
    for (const char* integrator : {"bdf1", "bdf2"}) {
      // Far more than any cache holds.
      const int steps = 64 * 16384 / (n * n);
      Motion motion = swinging_chain(n, integrator, steps);
      Linearizer linearizer(motion.horizon);
      const Linearization& system = linearizer.linearize(motion.trajectory);
      const solvers::SparseMatrix& H = system.H.matrix();
      solvers::BlockSubstitution solver(system.block_sizes);
      solver.analyze(H);
      const double factorize = fastest(repetitions, [&] { solver.factorize(H); });
      const Eigen::VectorXd b = Eigen::VectorXd::Ones(H.rows());
      Eigen::VectorXd x(H.rows());
      volatile double sum = 0.0;
      const double read = fastest(4 * repetitions, [&] {
        sum = Eigen::Map<const Eigen::VectorXd>(H.valuePtr(), H.nonZeros()).sum();
      });
      const double solve = fastest(4 * repetitions, [&] { solver.solve(b, x); });
      const double transposed = fastest(4 * repetitions, [&] { solver.solve_transposed(b, x); });
      out << std::fixed << std::setprecision(2) << std::setw(4) << n << std::setw(8) << integrator
          << std::setw(7) << steps << std::setw(7) << std::setprecision(0)
          << 8e-6 * static_cast<double>(H.nonZeros()) << std::setprecision(2) << std::setw(10)
          << 1e3 * read << std::setw(11) << 1e3 * factorize << std::setw(8) << 1e3 * solve
          << std::setw(12) << 1e3 * transposed << std::setw(13) << solve / read << std::setw(17)
          << transposed / read << '\n';
    }
  }
}

void write_growth(int repetitions, std::ostream& out) {
  out << "\nA gradient by assembled matrices, chain of 7, BDF2\n"
      << "   steps   assemble us  and solve us   per step; H and dg/dp MB\n";
  std::vector<double> log_steps;
  std::vector<double> log_time;
  for (const int steps : {100, 1000, 10000, 100000}) {
    Motion motion = swinging_chain(7, "bdf2", steps);
    const Objective objective(squared_variables());
    AssembledAdjoint adjoint(motion.horizon);
    Linearizer linearizer(motion.horizon);
    const auto gradient = [&] {
      if (!adjoint.gradient(motion.trajectory, objective).q0.allFinite()) {
        throw NumericalFailure("gradient not finite");
      }
    };
    gradient();
    linearizer.linearize(motion.trajectory);
    const int count = steps > 10000 ? 2 : repetitions;
    const double whole = fastest(count, gradient);
    const double assemble = fastest(count, [&] { linearizer.linearize(motion.trajectory); });
    const Linearization& system = adjoint.linearization();
    const double bytes =
        12.0 * static_cast<double>(system.H.matrix().nonZeros() + system.dg_dp.nonZeros());
    log_steps.push_back(std::log(steps));
    log_time.push_back(std::log(whole));
    out << std::setw(8) << steps << std::setprecision(2) << std::setw(14) << 1e6 * assemble / steps
        << std::setw(14) << 1e6 * whole / steps << std::setw(27) << 1e-6 * bytes << '\n';
  }
  const Eigen::Map<Eigen::VectorXd> x(log_steps.data(), 4);
  const Eigen::Map<Eigen::VectorXd> y(log_time.data(), 4);
  const Eigen::VectorXd centred = x.array() - x.mean();
  out << "exponent of the whole in steps: " << centred.dot(y) / centred.squaredNorm() << '\n';
}

}  // namespace

void write_system_ratios(int repetitions, std::ostream& out) {
  write_streaming(repetitions, out);
  write_growth(repetitions, out);
}

}  // namespace hbar::benchmarks
