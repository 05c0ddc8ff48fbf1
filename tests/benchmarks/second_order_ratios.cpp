#include "tests/benchmarks/second_order_ratios.h"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <limits>
#include <ostream>

#include "hbar/adjoint/derivatives/second_order.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/benchmarks/hinges.h"
#include "tests/support/random.h"

namespace hbar::benchmarks {
namespace {

using hbar::testing::Random;

/// Processor time of a work in ms, the fastest of several.
template <typename Work>
double fastest_ms(int repetitions, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    work();
    best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

void write_row(const char* name, int parameters, const Horizon& horizon, const Inputs& inputs,
               int repetitions, std::ostream& out) {
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  Objective objective(squared_velocity());
  objective.add(effort());
  AdjointSweep adjoint(horizon);
  const double gradient =
      fastest_ms(repetitions, [&] { static_cast<void>(adjoint.gradient(trajectory, objective)); });
  HessianProduct hessian(horizon, objective);
  const double point =
      fastest_ms(repetitions, [&] { static_cast<void>(hessian.set_point(trajectory)); });
  Random random(3);
  const Inputs direction{random.vector(inputs.p.size()),
                         random.matrix(inputs.u.rows(), inputs.u.cols()),
                         random.vector(inputs.q0.size()), random.vector(inputs.q0.size())};
  const double product =
      fastest_ms(repetitions, [&] { static_cast<void>(hessian.along(direction)); });
  out << std::fixed << std::setw(12) << name << std::setw(5) << inputs.q0.size() << std::setw(8)
      << parameters << std::setprecision(2) << std::setw(12) << gradient << std::setw(12) << point
      << std::setw(12) << product << std::setw(15) << product / gradient << '\n';
}

}  // namespace

void write_second_order_ratios(int repetitions, std::ostream& out) {
  out << "Hessian-vector product against gradient, 200 steps of BDF2\n"
      << "       model    n  params gradient ms    point ms  product ms  product/gradient\n";
  for (const HingeModel& hinges : all_models()) {
    for (const bool parameters : {false, true}) {
      Model model = build_model(hinges);
      ParameterSet set = parameters ? ParameterSet::all(model) : ParameterSet();
      const int count = set.size();
      Horizon horizon(std::move(model), std::move(set),
                      {.integrator = "bdf2", .h = 0.005, .steps = 200});
      Inputs inputs = horizon.nominal_inputs();
      inputs.q0 = Random(2).vector(inputs.q0.size(), 0.3);
      write_row(hinges.name.c_str(), count, horizon, inputs, repetitions, out);
    }
  }
}

}  // namespace hbar::benchmarks
