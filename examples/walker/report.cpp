#include "report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hbar::walker {
namespace {

using Json = nlohmann::ordered_json;

std::string gap_text(const StateGap& gap) {
  return fmt::format("{:.1e} (rad, m), rates {:.1e}", gap.q, gap.qdot);
}

Json json_of(const StateGap& gap) { return {{"q", gap.q}, {"qdot", gap.qdot}}; }

Json json_of(const Stage& stage) {
  const solvers::IpoptResult& result = stage.outcome.result;
  const Gait& gait = stage.gait;
  return {{"status", std::string(solvers::to_string(result.status))},
          {"iterations", result.iterations},
          {"seconds", result.elapsed},
          {"objective", result.objective},
          {"violation", result.violation.amount},
          {"cost_of_transport", gait.cost_of_transport},
          {"work", gait.work},
          {"weight", gait.weight},
          {"thigh", gait.lengths[0]},
          {"shank", gait.lengths[1]},
          {"simulated",
           {{"solution_gap", json_of(gait.solution)},
            {"half_gait_gap", json_of(gait.half)},
            {"gait_gap", json_of(gait.whole)},
            {"least_normal_force", gait.load.minCoeff()},
            {"greatest_normal_force", gait.load.maxCoeff()},
            {"friction_use", gait.friction_use},
            {"slip", gait.slip}}}};
}

}  // namespace

std::string summary(const Plan& plan, const std::vector<Stage>& stages) {
  const Gait& a = stages.front().gait;
  const Gait& b = stages.back().gait;
  std::string text = fmt::format("\n{:<34} {:>10} {:>10}\n", "", "first gait", "optimum");
  const auto row = [&](const char* name, double before, double after) {
    text += fmt::format("{:<34} {:>10.4f} {:>10.4f}\n", name, before, after);
  };
  row("cost of transport", a.cost_of_transport, b.cost_of_transport);
  row("work per step, J", a.work, b.work);
  row("weight, N", a.weight, b.weight);
  row("thigh, m", a.lengths[0], b.lengths[0]);
  row("shank, m", a.lengths[1], b.lengths[1]);
  row("greatest load of a foot / weight", a.load.maxCoeff() / a.weight,
      b.load.maxCoeff() / b.weight);
  row("least load of a foot, N", a.load.minCoeff(), b.load.minCoeff());
  row("friction / normal force, most", a.friction_use, b.friction_use);
  row("slip of the feet per step, m", a.slip, b.slip);
  text += "iterations of the stages:";
  for (const Stage& stage : stages) {
    text += fmt::format(" {}", stage.outcome.result.iterations);
  }
  text += fmt::format("; largest violation of a constraint: {:.1e}\n",
                      stages.back().outcome.result.violation.amount);
  text += fmt::format(
      "simulated from the start with these controls: the optimum's path is met to {};\n"
      "after half a gait the mirrored start is missed by {},\nafter a whole one the start by {}\n",
      gap_text(b.solution), gap_text(b.half), gap_text(b.whole));
  return text + fmt::format("which foot carries, in {:g} s (# over half the weight, + less):\n{}",
                            2.0 * plan.duration, gait_diagram(b));
}

std::string result_json(const Plan& plan, const std::vector<Stage>& stages) {
  Json out = {{"steps", plan.steps},
              {"duration", plan.duration},
              {"speed", plan.speed},
              {"lengths", plan.length_share > 0.0 ? "free" : "fixed"},
              {"stages", Json::array()}};
  for (const Stage& stage : stages) {
    out["stages"].push_back(json_of(stage));
  }
  return out.dump(1) + '\n';
}

}  // namespace hbar::walker
