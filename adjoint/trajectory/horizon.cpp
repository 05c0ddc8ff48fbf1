#include "hbar/adjoint/trajectory/horizon.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/memory_estimate.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar {
namespace {

void check_options(const Model& model, const SimulationOptions& options) {
  if (!(options.h > 0.0) || !std::isfinite(options.h)) {
    throw InvalidInput(concat("time step h is ", options.h, "; it must be positive"));
  }
  if (options.h < kSmallestStep || options.h > 1.0 / kSmallestStep) {
    throw InvalidInput(concat("time step h is ", options.h, "; it must be between ", kSmallestStep,
                              " and ", 1.0 / kSmallestStep, ": its square must be a number"));
  }
  if (options.steps < 1) {
    throw InvalidInput(concat("steps is ", options.steps, "; it must be at least 1"));
  }
  const solvers::NewtonOptions& newton = options.newton;
  if (!(newton.tol > 0.0 && newton.rtol > 0.0) || !std::isfinite(newton.tol) ||
      !std::isfinite(newton.rtol) || newton.max_iter < 1 || newton.max_ls < 0 ||
      options.max_halvings < 0 || !(options.max_memory > 0.0)) {
    throw InvalidInput(concat("newton: tol is ", newton.tol, ", rtol ", newton.rtol, ", max_iter ",
                              newton.max_iter, ", max_ls ", newton.max_ls, ", max_halvings ",
                              options.max_halvings, ", max_memory ", options.max_memory,
                              "; tolerances and memory must be positive, tolerances finite, "
                              "max_iter at least 1 and the others not negative"));
  }
  for (const int step : options.restarts) {
    if (step < 0 || step >= options.steps) {
      throw InvalidInput(
          concat("restart at step ", step, "; there are steps 0 to ", options.steps - 1));
    }
  }
  if (model.dof() == 0) {
    throw InvalidInput("the model has no coordinate: every joint is fixed");
  }
}

void check_input(const Eigen::MatrixXd& value, std::string_view name, Eigen::Index rows,
                 Eigen::Index columns) {
  if (value.rows() != rows || value.cols() != columns) {
    throw InvalidInput(concat(name, " is ", value.rows(), " x ", value.cols(), "; it must be ",
                              rows, " x ", columns));
  }
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      if (!std::isfinite(value(i, j))) {
        throw InvalidInput(
            concat(name, "(", i, ", ", j, ") is ", value(i, j), "; it must be finite"));
      }
    }
  }
}

MemoryCounts counts_of(const SimulationOptions& options, std::size_t measured, int parameters) {
  return {options.integrator, options.steps, static_cast<int>(options.restarts.size()),
          static_cast<int>(measured), parameters};
}

}  // namespace

MemoryEstimate estimate_memory(const Horizon& horizon) {
  return estimate_memory(
      horizon.model(),
      counts_of(horizon.options(), horizon.measured_names().size(), horizon.parameters().size()));
}

Horizon::Horizon(Model model, ParameterSet parameters, SimulationOptions options)
    : Horizon(std::make_shared<const Model>(std::move(model)), std::move(parameters),
              std::move(options)) {}

Horizon::Horizon(std::shared_ptr<const Model> model, ParameterSet parameters,
                 SimulationOptions options) {
  if (model == nullptr) {
    throw InvalidInput("horizon: there is no model (a null pointer)");
  }
  require_parameters_of(*model, parameters);
  Data data{.model = std::move(model),
            .parameters = std::move(parameters),
            .options = std::move(options),
            .measurements = {},
            .measured_rows = {},
            .measured_names = {}};
  data.integrator = &find_integrator(data.options.integrator);
  check_options(*data.model, data.options);
  check_measurements(*data.model, data.options.measurements);
  data.measurements = model_measurements(*data.model);
  data.measured_rows = {data.model->variable_count(), data.model->tactile_count()};
  data.measurements.insert(data.measurements.end(), data.options.measurements.begin(),
                           data.options.measurements.end());
  for (const Measurement& measurement : data.measurements) {
    const std::vector<std::string> rows = row_names(*data.model, measurement);
    data.measured_names.insert(data.measured_names.end(), rows.begin(), rows.end());
  }
  const MemoryEstimate memory = estimate_memory(
      *data.model, counts_of(data.options, data.measured_names.size(), data.parameters.size()));
  require_memory(*data.model, data.options.steps, memory, data.options.max_memory);
  data.keeps_factors = data.options.keep_factors && memory.total(true) <= data.options.max_memory;
  data_ = std::make_shared<const Data>(std::move(data));
}

Horizon Horizon::with(SimulationOptions options) const {
  return {shared_model(), parameters(), std::move(options)};
}

Inputs Horizon::nominal_inputs() const {
  return {parameters().nominal(), Eigen::MatrixXd::Zero(model().control_count(), steps()),
          Eigen::VectorXd::Zero(model().dof()), Eigen::VectorXd::Zero(model().dof())};
}

std::shared_ptr<const Mechanism<double>> Horizon::mechanism(const Eigen::VectorXd& p) const {
  require_in_range(parameters(), p);
  auto out = std::make_shared<Mechanism<double>>();
  apply_parameters<double>(model(), parameters(), p, *out);
  return out;
}

void Horizon::check(const Inputs& inputs) const {
  check_input(inputs.p, "p", parameters().size(), 1);
  check_input(inputs.u, "u", model().control_count(), steps());
  check_input(inputs.q0, "q0", model().dof(), 1);
  check_input(inputs.qdot0, "qdot0", model().dof(), 1);
}

int Horizon::measured_index(std::string_view name) const {
  const std::vector<std::string>& names = measured_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InvalidInput(
        concat("there is no measured row '", name, "'; ", unknown_name_hint(name, names)));
  }
  return static_cast<int>(found - names.begin());
}

}  // namespace hbar
