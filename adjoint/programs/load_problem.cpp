#include "hbar/adjoint/programs/load_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar {
namespace {

std::string integrator_name(scene::Integrator integrator) {
  constexpr std::array<const char*, 3> kNames = {"bdf1", "bdf2", "sdirk2"};
  return kNames[static_cast<std::size_t>(integrator)];
}

/// Steps that reach a duration; one that is a multiple of h but for rounding needs no further step.
int steps_of(double duration, double h) {
  const double steps = std::ceil(duration / h * (1.0 - 1e-12));
  if (!(duration > 0.0) || !(steps <= std::numeric_limits<int>::max())) {
    throw InvalidInput(concat("the time to simulate is ", duration, " with steps of ", h,
                              "; it must be positive, and at most ",
                              std::numeric_limits<int>::max(), " steps"));
  }
  return std::max(1, static_cast<int>(steps));
}

SimulationOptions simulation_options(const scene::Description& scene, const LoadOptions& options) {
  SimulationOptions out;
  out.integrator = options.integrator.value_or(integrator_name(scene.options.integrator));
  out.h = options.h.value_or(scene.options.timestep);
  out.steps = options.duration ? steps_of(*options.duration, out.h) : options.steps;
  out.newton.tol = options.newton_tol.value_or(scene.solver_options.tol);
  out.newton.rtol = scene.solver_options.rtol.value_or(out.newton.rtol);
  out.newton.max_iter = scene.solver_options.max_iter;
  out.newton.max_ls = scene.solver_options.max_ls;
  out.keep_factors = options.keep_factors;
  out.max_memory = options.max_memory.value_or(out.max_memory);
  out.stop = options.stop;
  return out;
}

ParameterSet choose_parameters(const Model& model, const LoadOptions& options) {
  switch (options.parameters) {
    case ParameterChoice::kMask:
      return ParameterSet::masked(model);
    case ParameterChoice::kAll:
      return ParameterSet::all(model);
    case ParameterChoice::kNone:
      return {};
    case ParameterChoice::kNamed:
      return ParameterSet::named(model, options.parameter_names);
  }
  throw InvalidInput("load_problem: unknown choice of parameters");
}

ObjectiveChoice choose_objective(const Model& model, const LoadOptions& options) {
  const bool has_variables = model.variable_count() > 0;
  if (options.objective == ObjectiveChoice::kVariables && !has_variables) {
    throw InvalidInput(
        "objective variables: the scene has none; add an <endeffector>, or take final-position");
  }
  if (options.objective == ObjectiveChoice::kTactile && model.tactile_count() == 0) {
    throw InvalidInput(
        "objective tactile: the scene has no sensor; add a <tactile>, or take another objective");
  }
  return options.objective.value_or(has_variables ? ObjectiveChoice::kVariables
                                                  : ObjectiveChoice::kFinalPosition);
}

Objective make_objective(ObjectiveChoice choice) {
  switch (choice) {
    case ObjectiveChoice::kVariables:
      return Objective(squared_variables());
    case ObjectiveChoice::kFinalPosition:
      return Objective(squared_final_position());
    case ObjectiveChoice::kTactile:
      return Objective(squared_tactile());
  }
  throw InvalidInput("load_problem: unknown choice of objective");
}

LoadedProblem make_problem(Model model, const SimulationOptions& simulation,
                           const LoadOptions& options) {
  if (options.newton_tol && !(*options.newton_tol > 0.0)) {
    throw InvalidInput(concat("Newton tolerance is ", *options.newton_tol, "; it must be > 0"));
  }
  const ObjectiveChoice objective = choose_objective(model, options);
  ParameterSet parameters = choose_parameters(model, options);
  Horizon horizon(std::move(model), std::move(parameters), simulation);
  Inputs inputs = horizon.nominal_inputs();
  return {
      {std::move(horizon), make_objective(objective), std::move(inputs)}, objective, {}, {}, {}};
}

/// Names of the files that a body uses.
std::vector<std::string> files_of(const scene::Body& body) {
  std::vector<std::string> names;
  std::optional<std::string> contacts;
  if (const auto* mesh = std::get_if<scene::MeshBody>(&body.shape)) {
    names.push_back(mesh->filename);
    contacts = mesh->contacts;
  }
  if (const auto* abstract = std::get_if<scene::AbstractBody>(&body.shape)) {
    contacts = abstract->contacts;
    if (abstract->collision) {
      names.push_back(abstract->collision->contacts);
    }
  }
  if (contacts) {
    names.push_back(*contacts);
  }
  return names;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path,
                                            const scene::Scene& scene) {
  std::vector<std::filesystem::path> files = {path};
  std::unordered_set<std::string> known = {path.native()};
  const auto add = [&](const std::string& name) {
    std::filesystem::path file = scene.find(name);
    if (known.insert(file.native()).second) {
      files.push_back(std::move(file));
    }
  };
  for (const scene::Robot& robot : scene.description.robots) {
    for (const scene::Link& link : robot.links) {
      const std::vector<std::string> names = files_of(link.body);
      std::for_each(names.begin(), names.end(), add);
    }
  }
  for (const scene::TactileSensor& sensor : scene.description.tactile_sensors) {
    if (const auto* list = std::get_if<scene::PointList>(&sensor.points)) {
      add(list->spec);
    }
  }
  return files;
}

}  // namespace

LoadedProblem load_problem(const std::filesystem::path& path, const LoadOptions& options) {
  scene::Scene scene = scene::read_scene(path);
  Model model = scene::build_model(scene, &scene.notices, options.stop);
  if (model.dof() == 0) {
    throw InvalidInput(concat(scene.file, ": no joint has a coordinate: there is nothing to move"));
  }
  try {
    LoadedProblem out =
        make_problem(std::move(model), simulation_options(scene.description, options), options);
    out.linear_solver =
        options.linear_solver.value_or(scene.description.solver_options.linear_solver);
    out.notices = std::move(scene.notices);
    out.files = files_of(path, scene);
    return out;
  } catch (const InvalidInput& error) {
    throw InvalidOption(error.what());
  }
}

}  // namespace hbar
