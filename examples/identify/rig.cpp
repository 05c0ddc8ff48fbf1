#include "rig.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "hbar/adjoint/design/formula_map.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::identify {
namespace {

constexpr double kTimeStep = 0.01;   // s
constexpr double kFirstAngle = 0.8;  // of the rod, rad

// Shares of the greatest forces, each for a tenth of the time: pushes to and fro, so that inertia,
// damping and friction do not look alike, with the shoe down, half down and up.
constexpr std::array<double, 10> kPush = {0.6, -0.5, 0.5, 0.2, -0.6, 0.4, 0.3, -0.6, -0.1, 0.5};
constexpr std::array<double, 10> kPress = {-0.5, -0.5, 0.0,  -0.8, -0.8,
                                           -0.4, 0.0,  -0.6, -0.3, -0.7};

// Where a fit begins unless told: factors of the truth.
constexpr std::array<double, 5> kWrong = {1.6, 0.6, 2.5, 0.4, 0.5};

bool is_mass(const std::string& name) {
  return name.starts_with("body.") && name.ends_with(".mass");
}

/// "body.rod.inertia" of "body.rod.mass".
std::string inertia_of(const std::string& mass) {
  return mass.substr(0, mass.size() - std::string("mass").size()) + "inertia";
}

Eigen::MatrixXd excitation(int steps, bool sliding) {
  Eigen::MatrixXd u(2, steps);
  for (int k = 0; k < steps; ++k) {
    const auto part = static_cast<std::size_t>(10 * k / steps);
    u.col(k) << kPush[part], sliding ? kPress[part] : 0.0;
  }
  return u;
}

/// The names of the controls and of the coordinates that are measured.
study::TrajectoryNames recorded_names(const Rig& rig, const Sigmas& sigmas,
                                      std::vector<int>& coordinates) {
  const study::TrajectoryNames all = study::trajectory_names(rig.horizon);
  study::TrajectoryNames out;
  out.u = all.u;
  for (std::size_t i = 0; i < all.q.size(); ++i) {
    if (sigmas.contains(all.q[i])) {
      out.q.push_back(all.q[i]);
      coordinates.push_back(static_cast<int>(i));
    }
  }
  if (out.q.empty()) {
    throw InvalidInput("identify: no coordinate of the scene has a standard deviation");
  }
  return out;
}

}  // namespace

ParameterSet unknown_parameters(const Model& model, const std::vector<std::string>& unknowns) {
  std::vector<std::string> names;
  for (const std::string& unknown : unknowns) {
    names.push_back(unknown);
    if (is_mass(unknown)) {
      names.push_back(inertia_of(unknown));
    }
  }
  return ParameterSet::named(model, names);
}

DesignMapPointer unknowns_map(const ParameterSet& set, const std::vector<std::string>& unknowns,
                              const Eigen::VectorXd& start) {
  std::vector<DesignVariable> variables;
  for (const std::string& name : unknowns) {
    const Parameter& parameter = set[set.find(name)];
    const double x = parameter.nominal;
    if (!(x > 0.0)) {
      throw InvalidInput(concat("identify: '", name, "' is ", x,
                                " in the scene; what is unknown must be positive there"));
    }
    const double first = x * start[static_cast<Eigen::Index>(variables.size())];
    variables.push_back({name, parameter.unit, first, 1e-3 * x, 1e3 * x, x});
  }
  return formula_map(set, design_variables(variables), [=](auto d, auto& p) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const auto growth = d[i] / p[unknowns[i]].value;
      p[unknowns[i]] = d[i];
      if (is_mass(unknowns[i])) {
        for (const char* axis : {".x", ".y", ".z"}) {
          p[inertia_of(unknowns[i]) + axis] *= growth;
        }
      }
    }
  });
}

Sigmas default_sigmas() { return {{"rail", 1e-3}, {"hinge", 5e-3}}; }

std::vector<std::string> default_unknowns() {
  return {"body.carriage.mass", "body.rod.mass", "joint.rail.damping", "joint.hinge.damping",
          "contact.brake.mu"};
}

Rig make_rig(const RigOptions& options) {
  const Model model = scene::build_model(scene::read_scene(options.scene));
  if (model.dof() != 3 || model.control_count() != 2) {
    throw InvalidInput(
        concat("identify: the scene has ", model.dof(), " coordinates and ", model.control_count(),
               " motors; it must have rail, guide and hinge, and a motor on rail and "
               "guide"));
  }
  const ParameterSet set = unknown_parameters(model, options.unknowns);
  Eigen::VectorXd start = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(options.unknowns.size()));
  for (Eigen::Index i = 0; options.wrong_start && i < start.size(); ++i) {
    start[i] = kWrong[static_cast<std::size_t>(i) % kWrong.size()];
  }
  Eigen::VectorXd nominal = start;
  for (Eigen::Index i = 0; i < nominal.size(); ++i) {
    nominal[i] = set[set.find(options.unknowns[static_cast<std::size_t>(i)])].nominal;
  }
  SimulationOptions simulation;
  simulation.integrator = "bdf2";
  simulation.h = kTimeStep;
  simulation.steps = options.steps;
  simulation.restarts = segment_starts(options.steps, options.segments);
  return {.horizon = Horizon(model, set, simulation),
          .map = unknowns_map(set, options.unknowns, start),
          .nominal = nominal,
          .u = excitation(options.steps, options.sliding),
          .q0 = Eigen::Vector3d(0.0, 0.0, kFirstAngle)};
}

std::string recorded_csv(const Rig& rig, const Sigmas& sigmas, std::mt19937_64& random) {
  std::vector<int> coordinates;
  const study::TrajectoryNames names = recorded_names(rig, sigmas, coordinates);
  Horizon horizon = rig.horizon;
  Inputs inputs = horizon.nominal_inputs();
  inputs.p = rig.map->parameters(rig.nominal);
  inputs.u = rig.u;
  inputs.q0 = rig.q0;
  const TrajectoryValues truth = read_values(horizon, simulate(horizon, inputs).trajectory());
  TrajectoryValues recorded;
  recorded.h = truth.h;
  recorded.u = truth.u;
  recorded.q.resize(static_cast<Eigen::Index>(coordinates.size()), truth.q.cols());
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    std::normal_distribution<double> error(0.0, sigmas.at(names.q[i]));
    for (Eigen::Index k = 0; k < truth.q.cols(); ++k) {
      recorded.q(row, k) = truth.q(coordinates[i], k) + error(random);
    }
  }
  return study::trajectory_csv(names, recorded);
}

Recording read_recording(const Rig& rig, const Sigmas& sigmas, const std::string& text,
                         const std::string& file) {
  const study::TrajectoryNames names = study::trajectory_names(rig.horizon);
  const study::TrajectoryData all = study::read_trajectory_csv(
      text, file, names, {.h = rig.horizon.options().h, .steps = rig.horizon.options().steps});
  Recording out;
  out.u = all.u.size() > 0 ? all.u : rig.u;
  out.data.names = all.names;
  std::vector<double> numbers;
  std::vector<double> sigma;
  for (std::size_t i = 0; i < all.places.size(); ++i) {
    const ValuePlace& place = all.places[i];
    const auto index = static_cast<std::size_t>(place.index);
    const std::string& name = place.field == ValueField::kQ      ? names.q[index]
                              : place.field == ValueField::kQdot ? names.qdot[index]
                                                                 : all.names[all.column[i]];
    const auto known = sigmas.find(name);
    if (known == sigmas.end()) {
      throw InvalidInput(concat(file, ": column '", name,
                                "' has no standard deviation; give --sigma ", name, "=NUMBER"));
    }
    out.data.places.push_back(place);
    out.data.column.push_back(all.column[i]);
    numbers.push_back(all.data[static_cast<Eigen::Index>(i)]);
    sigma.push_back(known->second);
  }
  const auto count = static_cast<Eigen::Index>(numbers.size());
  out.data.data = Eigen::Map<const Eigen::VectorXd>(numbers.data(), count);
  out.sigma = Eigen::Map<const Eigen::VectorXd>(sigma.data(), count);
  return out;
}

}  // namespace hbar::identify
