#include "text_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "labels.h"

namespace hbar::tool {
namespace {

/// Number of characters a UTF-8 text shows.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// Rows of cells, padded so that they stand below each other.
class Table {
 public:
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  [[nodiscard]] std::string text() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
      widths.resize(std::max(widths.size(), row.size()));
      for (std::size_t i = 0; i < row.size(); ++i) {
        widths[i] = std::max(widths[i], width(row[i]));
      }
    }
    std::string out;
    for (const auto& row : rows_) {
      std::string line = "  ";
      for (std::size_t i = 0; i < row.size(); ++i) {
        line += row[i] + std::string(widths[i] - width(row[i]) + 2, ' ');
      }
      out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    return out;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string range(double lower, double upper) {
  return fmt::format("[{:.4g}, {:.4g}]", lower, upper);
}

std::string link_lines(const Model& model) {
  Table table;
  std::vector<std::size_t> depth;
  for (const Link& link : model.links()) {
    depth.push_back(link.parent < 0 ? 0 : depth[static_cast<std::size_t>(link.parent)] + 1);
    std::string coordinates;
    const int index = static_cast<int>(depth.size()) - 1;
    const CoordinateRange own = model.coordinates_of_link(index);
    for (int i = own.begin; i < own.end; ++i) {
      coordinates +=
          fmt::format("{}q{} {}", i == own.begin ? "" : ", ", i, model.coordinate_name(i));
    }
    table.add({std::string(2 * depth.back(), ' ') + link.name, link.joint.name,
               std::string(joint_type(link.joint.kind)), link.body.name,
               fmt::format("{} {}", number(link.body.mass), mass_unit(model.units())),
               coordinates});
  }
  return fmt::format("links ({}): name, joint, type, body, mass, coordinates\n{}",
                     model.link_count(), table.text());
}

std::string motor_lines(const Model& model) {
  Table table;
  for (std::size_t m = 0; m < model.motors().size(); ++m) {
    const Motor& motor = model.motors()[m];
    const bool position = motor.kind == Motor::Kind::kPosition;
    const int first = model.first_control(static_cast<int>(m));
    const int count = joint_dof(model.link(motor.link).joint.kind);
    for (int i = first; i < first + count; ++i) {
      std::string law = position ? fmt::format("position, P {}, D {}{}", number(motor.P),
                                               number(motor.D), motor.implicit ? ", implicit" : "")
                                 : "force";
      law += std::isfinite(motor.lower) || std::isfinite(motor.upper)
                 ? ", force in " + range(motor.lower, motor.upper)
                 : ", no limit";
      table.add({fmt::format("u{}", i), model.control_name(i), law});
    }
  }
  return fmt::format("controls ({}): name, motor\n{}", model.control_count(), table.text());
}

std::string variable_lines(const Model& model) {
  Table table;
  const std::vector<std::string> names = variable_names(model);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const EndEffector& point = model.end_effectors()[i / 3];
    table.add({fmt::format("v{}", i), names[i], std::string(length_unit(model.units())),
               "on link " + model.link(point.link).name});
  }
  return fmt::format("variables ({}): name, unit, end effector\n{}", model.variable_count(),
                     table.text());
}

std::string parameter_lines(const Model& model, const ParameterSet& selected) {
  std::set<std::string> marked;
  for (const Parameter& parameter : selected.parameters()) {
    marked.insert(parameter.name);
  }
  const ParameterSet all = ParameterSet::all(model);
  Table table;
  for (const Parameter& parameter : all.parameters()) {
    table.add({marked.contains(parameter.name) ? "*" : " ", parameter.name,
               number(parameter.nominal), parameter.unit, range(parameter.lower, parameter.upper)});
  }
  return fmt::format("parameters ({}, * selected: {}): name, nominal, unit, bounds\n{}", all.size(),
                     selected.size(), table.text());
}

/// The entry of largest magnitude: "largest 1.2 (u1 elbow, step 17)".
std::string control_gradient(const Model& model, const Eigen::MatrixXd& u) {
  Eigen::Index control = 0;
  Eigen::Index step = 0;
  u.cwiseAbs().maxCoeff(&control, &step);
  return fmt::format("norm {}, largest {} ({}, step {})", number(u.norm()),
                     number(u(control, step)), model.control_name(static_cast<int>(control)),
                     step + 1);
}

std::string gradient_lines(const LoadedProblem& loaded, const Gradient& gradient) {
  const Model& model = loaded.problem.simulator.model();
  const ParameterSet& parameters = loaded.problem.simulator.parameters();
  std::string text = "gradient of the objective\n";
  Table table;
  if (gradient.u.size() > 0) {
    table.add({"controls", control_gradient(model, gradient.u)});
  }
  const std::vector<std::string> names = coordinate_names(model);
  for (Eigen::Index i = 0; i < gradient.q0.size(); ++i) {
    table.add({"q0." + names[static_cast<std::size_t>(i)], number(gradient.q0[i])});
  }
  for (Eigen::Index i = 0; i < gradient.qdot0.size(); ++i) {
    table.add({"qdot0." + names[static_cast<std::size_t>(i)], number(gradient.qdot0[i])});
  }
  for (int i = 0; i < parameters.size(); ++i) {
    table.add({parameters[i].name, number(gradient.p[i])});
  }
  return text + table.text();
}

}  // namespace

std::string describe(const Model& model, const ParameterSet& selected) {
  const Eigen::Vector3d& g = model.gravity();
  const std::string_view length = length_unit(model.units());
  return fmt::format("{}: {} coordinates, units {} ({}, {}, s), gravity {} {} {} {}/s²\n\n",
                     model.name().empty() ? "(no name)" : model.name(), model.dof(),
                     unit_system(model), length, mass_unit(model.units()), number(g[0]),
                     number(g[1]), number(g[2]), length) +
         link_lines(model) + '\n' + motor_lines(model) + '\n' + variable_lines(model) + '\n' +
         parameter_lines(model, selected);
}

std::string summarize(const LoadedProblem& loaded, const Results& results) {
  const Simulator& simulator = loaded.problem.simulator;
  const Model& model = simulator.model();
  const SimulationOptions& options = simulator.options();
  const TrajectoryValues& values = results.values;
  const int iterations = std::accumulate(results.newton.begin(), results.newton.end(), 0);
  std::string text =
      fmt::format("{}: {} of {} steps of {} s by {}: {}\n",
                  model.name().empty() ? "(no name)" : model.name(), results.report.steps_done,
                  options.steps, number(options.h), options.integrator, results.status);
  text += fmt::format(
      "Newton corrections: {}, at most {} in a step; smallest time step {} s\n", iterations,
      results.newton.empty() ? 0 : *std::max_element(results.newton.begin(), results.newton.end()),
      number(results.report.smallest_h));
  Table table;
  const std::vector<std::string> names = coordinate_names(model);
  const std::vector<std::string> units = coordinate_units(model);
  const Eigen::Index last = values.q.cols() - 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    table.add(
        {names[i],
         fmt::format("{} → {} {}", number(values.q(row, 0)), number(values.q(row, last)), units[i]),
         fmt::format("{} → {} {}/s", number(values.qdot(row, 0)), number(values.qdot(row, last)),
                     units[i])});
  }
  const std::vector<std::string> variables = variable_names(model);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    table.add({variables[i], fmt::format("{} → {} {}", number(values.v(row, 0)),
                                         number(values.v(row, last)), length_unit(model.units()))});
  }
  text += fmt::format("from t = 0 to t = {} s\n{}", number(results.report.time), table.text());
  if (results.value) {
    text += fmt::format(
        "objective {}: {}\n",
        loaded.objective == ObjectiveChoice::kVariables ? "variables" : "final-position",
        fmt::format("{:.12g}", *results.value));
  }
  return results.gradient ? text + gradient_lines(loaded, *results.gradient) : text;
}

}  // namespace hbar::tool
