#include <nlohmann/json.hpp>

#include "results.h"

namespace hbar::solver_benchmark {
namespace {

using Json = nlohmann::ordered_json;

Json known(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

Json measurement_json(const Measurement& m) {
  Json out = {
      {"solver", m.solver}, {"ordering", m.ordering}, {"chosen", m.chosen}, {"failure", m.failure}};
  if (!m.solved()) {
    return out;
  }
  out["seconds"] = {{"analyse", m.analyse},
                    {"factorise", m.factorise},
                    {"refactorise", m.refactorise},
                    {"solve", m.solve},
                    {"solve_transposed", m.solve_transposed},
                    {"solve_many", m.solve_many}};
  out["factor_entries"] = m.entries;
  out["fill"] = m.fill;
  out["bytes"] = m.bytes;
  out["flops"] = known(m.flops);
  out["backward_error"] = m.backward_error;
  out["componentwise_error"] = m.componentwise_error;
  out["transposed_error"] = m.transposed_error;
  out["forward_error"] = known(m.forward_error);
  return out;
}

Json matrix_json(const MatrixResults& matrix) {
  const MatrixLabel& label = matrix.label;
  Json out = {{"name", label.name},
              {"source", label.source},
              {"family", label.family},
              {"system", label.system},
              {"integrator", label.integrator},
              {"dof", label.dof},
              {"steps", label.steps},
              {"h", label.h},
              {"structure", matrix.structure},
              {"rows", matrix.rows},
              {"entries", matrix.entries},
              {"condition", known(matrix.condition)},
              {"failure", matrix.failure},
              {"solvers", Json::array()}};
  for (const Measurement& measurement : matrix.measurements) {
    out["solvers"].push_back(measurement_json(measurement));
  }
  return out;
}

Json scaling_json(const BenchmarkResults& results) {
  Json out = Json::array();
  for (const ScalingAxis axis : {ScalingAxis::kSteps, ScalingAxis::kDof}) {
    for (const ScalingLine& line : scaling_lines(results, axis)) {
      out.push_back({{"axis", name_of(axis)},
                     {"group", line.group},
                     {"solver", line.solver},
                     {"at", line.at},
                     {"seconds", line.time},
                     {"bytes", line.memory},
                     {"time_exponent", line.time_slope()},
                     {"memory_exponent", line.memory_slope()}});
    }
  }
  return out;
}

}  // namespace

std::string results_json(const BenchmarkResults& results) {
  Json out = {{"hbar", HBAR_VERSION},
              {"clock", results.options.clock == Clock::kCpu ? "cpu" : "wall"},
              {"repeat", results.options.repeat},
              {"rhs", results.options.rhs},
              {"interrupted", results.interrupted},
              {"matrices", Json::array()},
              {"profiles", Json::array()}};
  for (const MatrixResults& matrix : results.matrices) {
    out["matrices"].push_back(matrix_json(matrix));
  }
  const CostTable table = cost_table(results);
  for (const ProfileLine& line : performance_profiles(table)) {
    out["profiles"].push_back({{"solver", line.solver},
                               {"matrices", line.matrices},
                               {"solved", line.ratios.size()},
                               {"best_on", line.wins},
                               {"mean_ratio", line.mean},
                               {"ratios", line.ratios}});
  }
  const double automatic = mean_ratio_to_best_other(table, "auto");
  out["auto_over_best"] = automatic > 0.0 ? Json(automatic) : Json();
  out["scaling"] = scaling_json(results);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace hbar::solver_benchmark
