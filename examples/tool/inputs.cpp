#include "inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "entries.h"
#include "examples/common/process.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"
#include "labels.h"
#include "results_memory.h"
#include "start_row.h"

namespace hbar::tool {

using example::ExitCode;
using example::ProgramError;
namespace {

[[noreturn]] void bad_file(const std::string& message) {
  throw ProgramError(ExitCode::kBadScene, message);
}

std::string counted(std::size_t count, std::string_view noun, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? noun : plural);
}

/// Whether a line names columns: none of its entries could be meant as a number.
bool is_header(std::string_view line) {
  std::string reason;
  const std::vector<std::string_view> entries = split_entries(line, reason);
  return !entries.empty() && std::all_of(entries.begin(), entries.end(), [](std::string_view e) {
    std::string lower;
    for (const char c : e) {
      lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const bool number = lower.starts_with("nan") || lower.starts_with("inf");
    const bool begins = std::isalpha(static_cast<unsigned char>(e[0])) != 0 || e[0] == '_' ||
                        e[0] == '"' || e[0] == '#';
    return begins && !number;
  });
}

/// Controls from a file with a row per step and a column per control.     [controls x steps]
Eigen::MatrixXd read_controls(const std::string& path, const Model& model, int steps) {
  const std::string text = scene::read_text_file(path);
  const auto count = static_cast<std::size_t>(model.control_count());
  if (count == 0) {
    bad_file(fmt::format("{}: the scene has no motor, hence no control to set", path));
  }
  Eigen::MatrixXd controls(model.control_count(), steps);
  int rows = 0;
  bool first = true;
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) {
    rest.remove_prefix(3);
  }
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (scene::split_words(line).empty()) {
      continue;
    }
    const bool header = first && is_header(line);
    first = false;
    if (header) {
      continue;
    }
    std::string reason;
    const std::vector<double> row = parse_numbers(line, reason);
    if (!reason.empty()) {
      bad_file(fmt::format("{}:{}: {}", path, line_number, reason));
    }
    if (row.size() != count) {
      bad_file(fmt::format("{}:{}: {}; one per control is needed: {}", path, line_number,
                           counted(row.size(), "entry", "entries"),
                           fmt::join(control_names(model), ", ")));
    }
    if (rows < steps) {
      controls.col(rows) =
          Eigen::Map<const Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
    }
    ++rows;
  }
  if (rows != steps) {
    bad_file(fmt::format(
        "{}: {}; one per step is needed: {}", path,
        counted(static_cast<std::size_t>(rows), "row of controls", "rows of controls"), steps));
  }
  return controls;
}

void set_state(const std::optional<std::vector<double>>& given, std::string_view option,
               const Model& model, Eigen::VectorXd& state) {
  if (!given) {
    return;
  }
  if (given->size() != static_cast<std::size_t>(model.dof())) {
    throw ProgramError(ExitCode::kUsage,
                       fmt::format("{}: {}; one per coordinate is needed: {}", option,
                                   counted(given->size(), "entry", "entries"),
                                   fmt::join(coordinate_names(model), ", ")));
  }
  state =
      Eigen::Map<const Eigen::VectorXd>(given->data(), static_cast<Eigen::Index>(given->size()));
}

/// A time that the steps do not end at.
void notice_time(const Arguments& arguments, LoadedProblem& loaded) {
  const SimulationOptions& options = loaded.problem.horizon.options();
  const double end = options.steps * options.h;
  if (arguments.load.duration && std::abs(end - *arguments.load.duration) > 1e-9 * end) {
    loaded.notices.push_back(
        fmt::format("--time {:g} is no multiple of the time step {:g}; the simulation takes {} "
                    "steps and ends at {:g}",
                    *arguments.load.duration, options.h, options.steps, end));
  }
}

/// Total mass of the bodies.
double mass_of(const Model& model) {
  double mass = 0.0;
  for (int i = 0; i < model.link_count(); ++i) {
    mass += model.link(i).body.mass;
  }
  return mass;
}

/// A contact that begins pushing with a hundred times the weight of all bodies throws them out.
void notice_start(LoadedProblem& loaded) {
  constexpr double kWeights = 100.0;
  const Horizon& horizon = loaded.problem.horizon;
  const Model& model = horizon.model();
  if (model.contact_count() == 0) {
    return;
  }
  const double weight = mass_of(model) * model.gravity().norm();
  const std::vector<ContactSummary> contacts =
      ValueReader(horizon).contacts_at_start(loaded.problem.inputs);
  for (int i = 0; i < model.contact_count(); ++i) {
    const ContactSummary& contact = contacts[static_cast<std::size_t>(i)];
    if (contact.normal_force > kWeights * weight && contact.penetration > 0.0) {
      loaded.notices.push_back(fmt::format(
          "contact {}: starts {:g} deep, where its normal force is {:g}: more than {:g} times the "
          "weight of all bodies; it will throw them apart",
          contact_names(model)[static_cast<std::size_t>(i)], contact.penetration,
          contact.normal_force, kWeights));
    }
  }
}

}  // namespace

LoadedProblem load(const Arguments& arguments) {
  try {
    LoadedProblem loaded = load_problem(arguments.scene, arguments.load);
    require_memory(arguments, loaded);
    Inputs& inputs = loaded.problem.inputs;
    const Model& model = loaded.problem.horizon.model();
    set_state(arguments.q0, "--q0", model, inputs.q0);
    set_state(arguments.qdot0, "--qdot0", model, inputs.qdot0);
    if (arguments.from) {
      loaded.files.push_back(read_start_row(*arguments.from, model, inputs));
    }
    notice_time(arguments, loaded);
    if (arguments.controls) {
      inputs.u = read_controls(*arguments.controls, model, loaded.problem.horizon.steps());
      loaded.files.emplace_back(*arguments.controls);
    }
    notice_start(loaded);
    return loaded;
  } catch (const InvalidOption& error) {
    throw ProgramError(ExitCode::kUsage, error.what());
  } catch (const InvalidInput& error) {
    throw ProgramError(ExitCode::kBadScene, error.what());
  }
}

}  // namespace hbar::tool
