#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace hbar::finger_reach {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  Json out = Json::array();
  for (const double entry : vector) {
    out.push_back(entry);
  }
  return out;
}

/// A violated row, worst first.
struct Violated {
  std::string name;
  double amount = 0.0;
};

std::vector<Violated> violations(const Reach& reach, const Outcome& outcome, double tolerance) {
  const solvers::NlpConstraints& limits = reach.problem->constraint_limits();
  std::vector<Violated> out;
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i) {
    const double c = outcome.optimised.result.c[i];
    const double amount = std::max(limits.lower[i] - c, c - limits.upper[i]);
    if (!(amount <= tolerance)) {
      out.push_back({limits.names[static_cast<std::size_t>(i)], amount});
    }
  }
  std::sort(out.begin(), out.end(),
            [](const Violated& a, const Violated& b) { return a.amount > b.amount; });
  return out;
}

double solver_time(const example::Optimised& optimised) {
  const TranscriptionTimes& times = optimised.times;
  return optimised.result.elapsed - times.simulation - times.gradient - times.jacobian -
         times.hessian;
}

void add(std::string& text, const std::string& line) { text += line + '\n'; }

void add_violations(std::string& text, const Reach& reach, const Outcome& outcome) {
  constexpr double kTolerance = 1e-6;
  const std::vector<Violated> violated = violations(reach, outcome, kTolerance);
  if (violated.empty()) {
    add(text,
        fmt::format("constraints: all {} met, largest violation {:.1e}",
                    outcome.optimised.result.c.size(), outcome.optimised.result.violation.amount));
    return;
  }
  add(text, fmt::format("constraints: {} of {} violated", violated.size(),
                        outcome.optimised.result.c.size()));
  for (std::size_t i = 0; i < std::min<std::size_t>(violated.size(), 10); ++i) {
    add(text, fmt::format("  {:<28} by {:.3e}", violated[i].name, violated[i].amount));
  }
}

}  // namespace

double finger_length(const Reach& reach, const Eigen::VectorXd& x) {
  return reach.problem->design(x).head<3>().sum();
}

double finger_mass(const Reach& reach, const Eigen::VectorXd& x) {
  const Eigen::VectorXd d = reach.problem->design(x);
  double mass = 0.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    mass += reach.phalanges[static_cast<std::size_t>(i)].density * d[i] * d[3 + i] * d[3 + i];
  }
  return mass;
}

std::string summary(const Reach& reach, const Outcome& outcome) {
  const solvers::IpoptResult& result = outcome.optimised.result;
  const DesignVariables& design = reach.problem->problem().map->variables();
  const double length = finger_length(reach, result.x);
  std::string text;
  add(text, fmt::format("effort:      {:.6f} before, {:.6f} after {} iterations",
                        outcome.start_objective, result.objective, result.iterations));
  add_violations(text, reach, outcome);
  add(text, fmt::format("{:<20} {:>10} {:>10}", "design", "before", "after"));
  for (Eigen::Index i = 0; i < 6; ++i) {
    add(text,
        fmt::format("  {:<18} {:>7.2f} mm {:>7.2f} mm", design.names[static_cast<std::size_t>(i)],
                    1e3 * outcome.start[i], 1e3 * result.x[i]));
  }
  add(text,
      fmt::format("  {:<18} {:>7.2f} g  {:>7.2f} g", "mass of phalanges",
                  1e3 * finger_mass(reach, outcome.start), 1e3 * finger_mass(reach, result.x)));
  const Eigen::VectorXd errors = tip_errors(reach, outcome.values);
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    add(text, fmt::format("target {} at {:.2f} s: tip {:.3f} mm away, {:.2f} % of the finger",
                          i + 1, reach.targets[static_cast<std::size_t>(i)].step * outcome.values.h,
                          1e3 * errors[i], 100.0 * errors[i] / length));
  }
  return text;
}

std::string result_json(const Reach& reach, const Outcome& outcome) {
  const solvers::IpoptResult& result = outcome.optimised.result;
  const DesignVariables& design = reach.problem->problem().map->variables();
  const SimulationOptions& simulation = reach.problem->problem().horizon.options();
  Json out = {{"status", solvers::to_string(result.status)},
              {"converged", result.converged()},
              {"feasible", result.feasible},
              {"message", result.message},
              {"integrator", simulation.integrator},
              {"h", simulation.h},
              {"steps", simulation.steps},
              {"iterations", result.iterations},
              {"objective", {{"before", outcome.start_objective}, {"after", result.objective}}}};
  out["violation"] = {{"largest", result.violation.amount}, {"name", result.violation.name}};
  out["violated"] = Json::array();
  for (const Violated& row : violations(reach, outcome, 1e-6)) {
    out["violated"].push_back({{"name", row.name}, {"amount", row.amount}});
  }
  out["design"] = Json::array();
  for (Eigen::Index i = 0; i < design.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    out["design"].push_back({{"name", design.names[k]},
                             {"unit", design.units[k]},
                             {"before", outcome.start[i]},
                             {"after", result.x[i]}});
  }
  out["mass"] = {{"before", finger_mass(reach, outcome.start)},
                 {"after", finger_mass(reach, result.x)}};
  const double length = finger_length(reach, result.x);
  const Eigen::VectorXd errors = tip_errors(reach, outcome.values);
  out["targets"] = Json::array();
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const Target& target = reach.targets[static_cast<std::size_t>(i)];
    out["targets"].push_back({{"step", target.step},
                              {"position", list(target.position)},
                              {"error", errors[i]},
                              {"error_per_length", errors[i] / length}});
  }
  out["controls"] = Json::array();
  const Eigen::Index first = design.size();
  for (int b = 0; b < reach.problem->input_variables().block_count(); ++b) {
    out["controls"].push_back(list(result.x.segment(first + 4 * b, 4)));
  }
  const TranscriptionTimes& times = outcome.optimised.times;
  out["seconds"] = {{"total", result.elapsed},    {"simulation", times.simulation},
                    {"gradient", times.gradient}, {"jacobian", times.jacobian},
                    {"hessian", times.hessian},   {"ipopt", solver_time(outcome.optimised)}};
  return out.dump(1) + '\n';
}

}  // namespace hbar::finger_reach
