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

/// A link's name, indented by its depth in the tree: down to a level at which lines would become
/// longer than what they say, and from there on with the depth in words.
std::string indented(std::size_t depth, const std::string& name) {
  constexpr std::size_t kDeepest = 20;
  const std::string indent(2 * std::min(depth, kDeepest), ' ');
  return depth <= kDeepest ? indent + name : fmt::format("{}{} (depth {})", indent, name, depth);
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
    table.add({indented(depth.back(), link.name), link.joint.name,
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

std::string counted_points(Eigen::Index count, const std::string& body) {
  return fmt::format("{} {} of {}", count, count == 1 ? "point" : "points", body);
}

std::string coefficients(const ContactCoefficients& c) {
  return fmt::format("kn {}, kt {}, mu {}, damping {}", number(c.kn), number(c.kt), number(c.mu),
                     number(c.damping));
}

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", number(v[0]), number(v[1]), number(v[2]));
}

/// The points that a contact tests.
std::string points_of(const Model& model, const Contact& contact) {
  const Body& body = model.link(contact.link).body;
  const bool rolls =
      std::holds_alternative<Plane>(contact.surface) && std::holds_alternative<Sphere>(body.shape);
  return rolls ? "deepest point of " + body.name
               : counted_points(body.contact_points.cols(), body.name);
}

/// What it tests them against.
std::string surface_of(const Model& model, const Contact& contact) {
  const std::string body = contact.other < 0 ? "ground" : model.link(contact.other).body.name;
  if (const auto* plane = std::get_if<Plane>(&contact.surface)) {
    return fmt::format("{}: plane through {}, normal {}", body, vector(plane->point),
                       vector(plane->normal));
  }
  const auto* own = std::get_if<OwnShape>(&contact.surface);
  if (own == nullptr) {
    return body + ": mesh";
  }
  const Shape& shape = model.link(contact.other).body.shape;
  return std::holds_alternative<Cylinder>(shape) && !own->caps ? body + " without end faces" : body;
}

std::string law_words(const Contact& contact) {
  std::string text = contact.normal_law == NormalLaw::kLinear ? "linear" : "document";
  if (contact.friction_law == FrictionLaw::kSmooth) {
    text += fmt::format(", smooth friction of width {}", number(contact.friction_width));
  }
  text += contact.adhesion ? "" : ", no adhesion";
  return contact.reaction == Reaction::kSurface ? text + ", reaction at the surface" : text;
}

std::string contact_lines(const Model& model) {
  Table table;
  for (const Contact& contact : model.contacts()) {
    table.add({contact.name, points_of(model, contact), surface_of(model, contact),
               coefficients(contact.coefficients), law_words(contact)});
  }
  return fmt::format("contacts ({}): name, points, against, coefficients, law\n{}",
                     model.contact_count(), table.text());
}

std::string sensor_lines(const Model& model) {
  Table table;
  for (const TactileSensor& sensor : model.tactile_sensors()) {
    std::set<std::string> felt;
    for (const Contact& contact : model.contacts()) {
      if (contact.other >= 0 && contact.other != sensor.link) {
        felt.insert(model.link(contact.other).body.name);
      }
    }
    table.add({sensor.name, counted_points(sensor.points.cols(), model.link(sensor.link).body.name),
               felt.empty() ? "nothing" : fmt::format("{}", fmt::join(felt, ", ")),
               coefficients(sensor.coefficients)});
  }
  return fmt::format("sensors ({}): name, points, bodies it feels, coefficients\n{}",
                     model.tactile_sensors().size(), table.text());
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

/// What each contact did from the start to the end.
std::string contact_table(const Model& model, const Results& results) {
  Table table;
  for (int i = 0; i < model.contact_count(); ++i) {
    std::size_t first = results.contact.size();
    std::size_t deepest = 0;
    double normal_force = 0.0;
    double active = 0.0;
    double sticking = 0.0;
    const auto at = [&results, i](std::size_t k) -> const ContactSummary& {
      return results.contact[k][static_cast<std::size_t>(i)];
    };
    for (std::size_t k = 0; k < results.contact.size(); ++k) {
      first = at(k).active > 0 ? std::min(first, k) : first;
      deepest = at(k).penetration > at(deepest).penetration ? k : deepest;
      normal_force = std::max(normal_force, at(k).normal_force);
      active += at(k).active;
      sticking += at(k).sticking;
    }
    if (active == 0.0) {
      table.add({model.contact(i).name, "no touch"});
      continue;
    }
    const auto time = [&results](std::size_t k) {
      return fmt::format("t = {} s", number(static_cast<double>(k) * results.values.h));
    };
    table.add({model.contact(i).name, "from " + time(first),
               fmt::format("{} {} at {}", number(at(deepest).penetration),
                           length_unit(model.units()), time(deepest)),
               fmt::format("{} {}", number(normal_force), force_unit(model)),
               fmt::format("{:.0f} %", 100.0 * sticking / active)});
  }
  return "contacts: first touch, deepest point, largest normal force, points that stick\n" +
         table.text();
}

/// The reading of largest magnitude of each sensor.
std::string sensor_table(const Model& model, const TrajectoryValues& values) {
  Table table;
  const std::vector<std::string> names = tactile_names(model);
  Eigen::Index first = 0;
  for (const TactileSensor& sensor : model.tactile_sensors()) {
    const Eigen::Index count = 3 * sensor.points.cols();
    Eigen::Index row = 0;
    Eigen::Index k = 0;
    values.tactile().middleRows(first, count).cwiseAbs().maxCoeff(&row, &k);
    const double largest = values.tactile()(first + row, k);
    table.add({sensor.name, fmt::format("{} {}", number(largest), force_unit(model)),
               largest == 0.0
                   ? ""
                   : fmt::format("{} at t = {} s", names[static_cast<std::size_t>(first + row)],
                                 number(static_cast<double>(k) * values.h))});
    first += count;
  }
  return "sensors: largest reading\n" + table.text();
}

std::string gradient_lines(const LoadedProblem& loaded, const Gradient& gradient) {
  const Model& model = loaded.problem.horizon.model();
  const ParameterSet& parameters = loaded.problem.horizon.parameters();
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
  return fmt::format("{}: {} coordinates, units {} ({}, {}, s), gravity {} {}/s²\n\n",
                     model.name().empty() ? "(no name)" : model.name(), model.dof(),
                     unit_system(model), length, mass_unit(model.units()), vector(g), length) +
         link_lines(model) + '\n' + motor_lines(model) + '\n' + variable_lines(model) + '\n' +
         contact_lines(model) + '\n' + sensor_lines(model) + '\n' +
         parameter_lines(model, selected);
}

std::string summarize(const LoadedProblem& loaded, const Results& results) {
  const Horizon& horizon = loaded.problem.horizon;
  const Model& model = horizon.model();
  const SimulationOptions& options = horizon.options();
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
    table.add(
        {variables[i], fmt::format("{} → {} {}", number(values.v()(row, 0)),
                                   number(values.v()(row, last)), length_unit(model.units()))});
  }
  text += fmt::format("from t = 0 to t = {} s\n{}", number(results.report.time), table.text());
  if (model.contact_count() > 0) {
    text += contact_table(model, results);
  }
  if (model.tactile_count() > 0) {
    text += sensor_table(model, values);
  }
  if (results.value) {
    text +=
        fmt::format("objective {}: {:.12g}\n", objective_name(loaded.objective), *results.value);
  }
  return results.gradient ? text + gradient_lines(loaded, *results.gradient) : text;
}

}  // namespace hbar::tool
