#include "results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {
namespace {

/// What stays the same while the axis' number grows; empty where that number is not known.
std::string group_of(const MatrixLabel& label, ScalingAxis axis) {
  if (label.steps == 0 || label.dof == 0) {
    return "";
  }
  if (axis == ScalingAxis::kSteps) {
    return concat(label.source, '_', label.integrator, '_', label.system);
  }
  return label.family.empty()
             ? ""
             : concat(label.family, '_', label.integrator, '_', label.steps, '_', label.system);
}

}  // namespace

std::string name_of(ScalingAxis axis) { return axis == ScalingAxis::kSteps ? "steps" : "dof"; }

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double covariance = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    covariance += dx * (std::log(y[i]) - mean_y);
    variance += dx * dx;
  }
  return covariance / variance;
}

double ScalingLine::time_slope() const { return fitted_exponent(at, time); }
double ScalingLine::memory_slope() const { return fitted_exponent(at, memory); }

std::string column_name(const Measurement& measurement) {
  return measurement.ordering == "default" ? measurement.solver
                                           : measurement.solver + '+' + measurement.ordering;
}

CostTable cost_table(const BenchmarkResults& results) {
  CostTable table;
  std::map<std::string, std::size_t> columns;
  for (const MatrixResults& matrix : results.matrices) {
    for (const Measurement& measurement : matrix.measurements) {
      if (columns.try_emplace(column_name(measurement), columns.size()).second) {
        table.solvers.push_back(column_name(measurement));
      }
    }
  }
  for (const MatrixResults& matrix : results.matrices) {
    std::vector<double> row(columns.size(), -1.0);
    for (const Measurement& measurement : matrix.measurements) {
      row[columns.at(column_name(measurement))] =
          measurement.solved() ? measurement.total() : std::numeric_limits<double>::infinity();
    }
    table.costs.push_back(std::move(row));
  }
  return table;
}

std::vector<ScalingLine> scaling_lines(const BenchmarkResults& results, ScalingAxis axis) {
  // By group, then by solver in the order of their first appearance, then by the axis' number.
  std::map<std::pair<std::string, std::string>, std::map<int, const Measurement*>> points;
  std::vector<std::pair<std::string, std::string>> order;
  for (const MatrixResults& matrix : results.matrices) {
    const std::string group = group_of(matrix.label, axis);
    for (const Measurement& measurement : matrix.measurements) {
      if (group.empty() || !measurement.solved()) {
        continue;
      }
      const std::pair key(group, column_name(measurement));
      if (!points.contains(key)) {
        order.push_back(key);
      }
      const int at = axis == ScalingAxis::kSteps ? matrix.label.steps : matrix.label.dof;
      points[key][at] = &measurement;
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ScalingLine> lines;
  for (const auto& key : order) {
    if (points[key].size() < 2) {
      continue;
    }
    ScalingLine line{.axis = axis, .group = key.first, .solver = key.second};
    for (const auto& [at, measurement] : points[key]) {
      line.at.push_back(at);
      line.time.push_back(measurement->total());
      line.memory.push_back(std::max(1.0, measurement->bytes));
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace hbar::solver_benchmark
