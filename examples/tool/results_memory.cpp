#include "results_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/memory_estimate.h"
#include "hbar/contact/contact_forces.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "hbar/core/parameters/sparsity.h"
#include "option_values.h"

namespace hbar::tool {
namespace {

constexpr double kNumber = sizeof(double);
constexpr double kText = 21.0;  // of a number with 17 digits and its separator
constexpr double kJsonNumber = 16.0;
constexpr double kJsonRow = 64.0;  // an array, its vector and their allocations
constexpr double kEntry = 20.0;    // of a sparse matrix, in the system and on the way into it

/// The numbers that decide.
struct Counts {
  explicit Counts(const Horizon& horizon)
      : steps(horizon.steps()),
        dof(horizon.model().dof()),
        controls(horizon.model().control_count()),
        read(horizon.measured_count()),
        written(horizon.model().variable_count() + horizon.model().tactile_count()),
        contacts(horizon.model().contact_count()) {}

  double steps, dof, controls, read, written, contacts;
};

/// Results: values, contacts, Newton's corrections.
double results_bytes(const Counts& c) {
  const double contact =
      c.contacts > 0.0 ? 48.0 + c.contacts * static_cast<double>(sizeof(ContactSummary)) : 0.0;
  return c.steps * ((2.0 * c.dof + c.read + c.controls) * kNumber + contact + 1.5 * sizeof(int));
}

double json_bytes(const Counts& c, bool with_gradient) {
  const double numbers = 2.0 * c.dof + c.written + 5.0 * c.contacts + 1.0;
  const double gradient = with_gradient ? c.controls : 0.0;
  const double rows = with_gradient ? 5.0 : 4.0;
  return c.steps * ((numbers + gradient) * (kJsonNumber + kText) + rows * kJsonRow);
}

double csv_bytes(const Counts& c) { return c.steps * kText * (1.0 + 2.0 * c.dof + c.written); }

/// What `check` holds beside a gradient: the assembled system, its factors, and a second
/// trajectory.
double check_bytes(const Horizon& horizon, const MemoryEstimate& memory, const Counts& c) {
  double entries = 0.0;
  for (const std::vector<int>& column : residual_pattern(horizon.model())) {
    entries += static_cast<double>(column.size());
  }
  double parameters = 0.0;
  for (const ParameterBlock& block : horizon.parameters().blocks()) {
    parameters += static_cast<double>(parameter_rows(horizon.model(), block).size()) * block.size;
  }
  constexpr double kBlocks = 4.0;  // of a row of the system: stages that one looks back on
  const auto stages = static_cast<double>(horizon.integrator().stages.size()) * c.steps;
  const double system = stages * (kEntry * (kBlocks * entries + parameters + c.controls) +
                                  kNumber * c.dof * (c.dof + 6.0));
  return memory.trajectory + system + results_bytes(c) + 8.0 * c.controls * c.steps * kNumber;
}

}  // namespace

double estimate_run(const Arguments& arguments, const LoadedProblem& loaded) {
  const Horizon& horizon = loaded.problem.horizon;
  const MemoryEstimate memory = estimate_memory(horizon);
  const Counts c(horizon);
  const double inputs = c.controls * c.steps * kNumber;
  const bool with_gradient = arguments.command == Command::kGradient;
  if (arguments.command == Command::kCheck) {
    return inputs + memory.total(horizon.keeps_factors()) + check_bytes(horizon, memory, c);
  }
  const double results = results_bytes(c);
  const double run = with_gradient ? memory.total(horizon.keeps_factors()) + results
                                   : memory.workspace + memory.trajectory + results;
  double writing = results + (with_gradient ? inputs : 0.0);
  writing += std::max(arguments.out ? json_bytes(c, with_gradient) : 0.0,
                      arguments.csv ? csv_bytes(c) : 0.0);
  return inputs + std::max(run, writing);
}

void require_memory(const Arguments& arguments, const LoadedProblem& loaded) {
  if (arguments.command == Command::kInfo) {
    return;
  }
  const double limit = loaded.problem.horizon.options().max_memory;
  const double bytes = estimate_run(arguments, loaded);
  if (bytes > limit) {
    usage(
        fmt::format("--steps: {} steps and their results take about {:.3g} GB; the limit is {:.3g} "
                    "GB: take fewer steps",
                    loaded.problem.horizon.steps(), bytes * 1e-9, limit * 1e-9));
  }
}

}  // namespace hbar::tool
