#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "labels.h"
#include "results.h"

namespace hbar::tool {
namespace {

using Json = nlohmann::ordered_json;

/// Writes JSON for people too: an object's members on lines of their own, lists of numbers on one.
class Writer {
 public:
  std::string write(const Json& json) {
    text_.reserve(kDigits * count(json));
    value(json, 0);
    text_ += '\n';
    return std::move(text_);
  }

 private:
  static constexpr std::size_t kDigits = 24;  // the longest number with its separator

  /// How many values there are: a text that grows while it is written is held twice.
  static std::size_t count(const Json& json) {
    std::size_t sum = 1;
    for (const Json& member : json) {
      sum += member.is_structured() ? count(member) : 1;
    }
    return sum;
  }

  void line(int depth) {
    text_ += '\n';
    text_.append(static_cast<std::size_t>(depth), ' ');
  }

  void value(const Json& json, int depth) {
    if (json.is_object()) {
      object(json, depth);
    } else if (json.is_array()) {
      array(json, depth);
    } else if (json.is_number_float()) {
      number(json.get<double>());
    } else {
      text_ += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
  }

  void number(double value) {
    if (!std::isfinite(value)) {
      throw NumericalFailure("a result is not finite, and JSON has no number for it");
    }
    fmt::format_to(std::back_inserter(text_), "{:.17g}", value);
  }

  void object(const Json& json, int depth) {
    const bool flat = std::none_of(json.begin(), json.end(),
                                   [](const Json& member) { return member.is_structured(); });
    text_ += '{';
    const char* separator = "";
    for (const auto& [key, member] : json.items()) {
      text_ += separator;
      separator = flat ? ", " : ",";
      if (!flat) {
        line(depth + 1);
      }
      text_ += Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
      value(member, depth + 1);
    }
    if (!flat) {
      line(depth);
    }
    text_ += '}';
  }

  void array(const Json& json, int depth) {
    const bool flat = json.empty() || !json.front().is_structured();
    text_ += '[';
    const char* separator = "";
    for (const Json& entry : json) {
      text_ += separator;
      separator = flat ? ", " : ",";
      if (!flat) {
        line(depth + 1);
      }
      value(entry, depth + 1);
    }
    if (!flat) {
      line(depth);
    }
    text_ += ']';
  }

  std::string text_;
};

Json list(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  Json::array_t out;
  out.reserve(static_cast<std::size_t>(vector.size()));
  for (const double entry : vector) {
    out.emplace_back(entry);
  }
  return out;
}

/// A row per column: time runs down a file.
Json rows(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  Json::array_t out;
  out.reserve(static_cast<std::size_t>(columns.cols()));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    out.push_back(list(columns.col(k)));
  }
  return out;
}

Json gradient_json(const ParameterSet& parameters, const Eigen::VectorXd& p,
                   const Gradient& gradient) {
  Json by_name = Json::array();
  for (int i = 0; i < parameters.size(); ++i) {
    by_name.push_back(
        {{"name", parameters[i].name}, {"value", p[i]}, {"derivative", gradient.p[i]}});
  }
  return {{"u", rows(gradient.u)},
          {"q0", list(gradient.q0)},
          {"qdot0", list(gradient.qdot0)},
          {"p", std::move(by_name)}};
}

/// What every file says of where it comes from.
Json header(const LoadedProblem& loaded) {
  const Horizon& horizon = loaded.problem.horizon;
  const Model& model = horizon.model();
  return {{"hbar", HBAR_VERSION},
          {"scene", loaded.files.front().string()},
          {"model", model.name()},
          {"units", unit_system(model)},
          {"integrator", horizon.options().integrator},
          {"h", horizon.options().h},
          {"steps", horizon.options().steps},
          {"newton_tol", horizon.options().newton.tol},
          {"linear_solver", loaded.linear_solver}};
}

/// By contact, what it did after each step.
Json contact_json(const Model& model, const Results& results) {
  Json out = Json::object();
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto contact = static_cast<std::size_t>(i);
    const auto history = [&results, contact](auto member) {
      Json::array_t numbers;
      numbers.reserve(results.contact.size());
      for (std::size_t k = 1; k < results.contact.size(); ++k) {
        numbers.emplace_back(results.contact[k][contact].*member);
      }
      return numbers;
    };
    out[model.contact(i).name] = {{"active", history(&ContactSummary::active)},
                                  {"sticking", history(&ContactSummary::sticking)},
                                  {"penetration", history(&ContactSummary::penetration)},
                                  {"normal_force", history(&ContactSummary::normal_force)},
                                  {"friction_force", history(&ContactSummary::friction_force)}};
  }
  return out;
}

}  // namespace

std::string results_json(const LoadedProblem& loaded, const Results& results) {
  const Model& model = loaded.problem.horizon.model();
  const TrajectoryValues& values = results.values;
  Json out = header(loaded);
  out["status"] = results.status;
  out["message"] = results.message;
  out["steps_done"] = results.report.steps_done;
  out["time"] = results.report.time;
  out["smallest_h"] = results.report.smallest_h;
  out["coordinates"] = coordinate_names(model);
  out["controls"] = control_names(model);
  out["variable_names"] = variable_names(model);
  out["q"] = rows(values.q);
  out["qdot"] = rows(values.qdot);
  out["variables"] = rows(values.v().rightCols(values.v().cols() - 1));
  out["contacts"] = contact_names(model);
  out["contact"] = contact_json(model, results);
  out["tactile_names"] = tactile_names(model);
  out["tactile"] = rows(values.tactile().rightCols(values.tactile().cols() - 1));
  out["newton_iterations"] = results.newton;
  out["objective_kind"] = objective_name(loaded.objective);
  if (results.value) {
    out["objective"] = *results.value;
  }
  if (results.gradient) {
    out["gradient"] =
        gradient_json(loaded.problem.horizon.parameters(), values.p, *results.gradient);
  }
  return Writer().write(out);
}

std::string check_json(const LoadedProblem& loaded, const GradientCheckReport& report) {
  Json out = header(loaded);
  out["objective_kind"] = objective_name(loaded.objective);
  out["passed"] = report.passed();
  out["classes"] = Json::array();
  for (const GradientCheckRow& row : report.rows) {
    Json entry = {{"name", row.name}, {"size", row.size}, {"difference_gap", row.difference_gap}};
    if (!row.resolved) {
      entry["difference_gap"] = Json();
    }
    entry["taylor_slope"] =
        row.remainder_vanishes || !row.resolved ? Json() : Json(row.taylor_slope);
    entry["dot_gap"] = row.dot_gap;
    entry["passed"] = row.passed;
    out["classes"].push_back(std::move(entry));
  }
  return Writer().write(out);
}

}  // namespace hbar::tool
