#include "plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "gnuplot.h"
#include "hbar/core/files/result_file.h"

namespace hbar::solver_benchmark {
namespace {

// gnuplot begins again after so many colours; the lines are dashed then.
constexpr int kColours = 8;

std::string head(const std::string& name, const std::string& title) {
  return fmt::format(
      "set terminal svg size 860,520 noenhanced font 'sans,13' background 'white'\n"
      "set output {}\nset title {}\nset grid\nset key outside right top\n",
      quoted(name + ".svg"), quoted(title));
}

std::string add_line(Plot& plot, std::size_t index, const std::string& style,
                     const std::string& title) {
  return fmt::format("{} {} index {} with {} dt {} title {}", index == 0 ? "plot" : ",\\\n    ",
                     quoted(plot.name + ".dat"), index, style, 1 + index / kColours, quoted(title));
}

enum class Quantity { kTime, kMemory };

/// One group's lines against the axis, log over log.
Plot scaling_plot(const std::vector<const ScalingLine*>& lines, Quantity quantity) {
  const ScalingLine& first = *lines.front();
  const bool time = quantity == Quantity::kTime;
  Plot plot;
  plot.name = file_name(
      fmt::format("{}_against_{}_{}", time ? "time" : "memory", name_of(first.axis), first.group));
  plot.script = head(plot.name, first.group) + "set logscale xy\n" +
                fmt::format("set xlabel '{}'\nset ylabel '{}'\n",
                            first.axis == ScalingAxis::kSteps ? "steps T" : "coordinates n",
                            time ? "analyse + factorise + solve, s" : "memory, bytes");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ScalingLine& line = *lines[i];
    const std::vector<double>& values = time ? line.time : line.memory;
    const double slope = time ? line.time_slope() : line.memory_slope();
    for (std::size_t k = 0; k < values.size(); ++k) {
      fmt::format_to(std::back_inserter(plot.data), "{} {}\n", line.at[k], values[k]);
    }
    plot.data += "\n\n";
    plot.script +=
        add_line(plot, i, "linespoints", fmt::format("{}: slope {:.2f}", line.solver, slope));
  }
  plot.script += '\n';
  return plot;
}

void add_scaling_plots(const BenchmarkResults& results, ScalingAxis axis,
                       std::vector<Plot>& plots) {
  const std::vector<ScalingLine> lines = scaling_lines(results, axis);
  std::map<std::string, std::vector<const ScalingLine*>> groups;
  for (const ScalingLine& line : lines) {
    groups[line.group].push_back(&line);
  }
  for (const auto& [group, members] : groups) {
    plots.push_back(scaling_plot(members, Quantity::kTime));
    plots.push_back(scaling_plot(members, Quantity::kMemory));
  }
}

/// Steps up at every ratio, to the right end of the figure.
void add_profile_line(const ProfileLine& line, double end, std::string& data) {
  const auto out = std::back_inserter(data);
  fmt::format_to(out, "1 {}\n", line.share(1.0));
  for (const double ratio : line.ratios) {
    if (ratio < end) {
      fmt::format_to(out, "{} {}\n", ratio, line.share(ratio));
    }
  }
  fmt::format_to(out, "{} {}\n\n\n", end, line.share(end));
}

Plot profile_plot(const std::vector<ProfileLine>& lines) {
  double end = 2.0;
  for (const ProfileLine& line : lines) {
    end = line.ratios.empty() ? end : std::max(end, 1.05 * line.ratios.back());
  }
  Plot plot{.name = "performance_profile", .data = {}, .script = {}};
  plot.script = head(plot.name, "performance profile of analyse + factorise + solve") +
                fmt::format(
                    "set logscale x 2\nset xrange [1:{}]\nset yrange [0:1.03]\n"
                    "set xlabel 'at most so many times the best solver''s time'\n"
                    "set ylabel 'share of the matrices'\n",
                    end);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    add_profile_line(lines[i], end, plot.data);
    plot.script += add_line(plot, i, "steps lw 2", lines[i].solver);
  }
  plot.script += '\n';
  return plot;
}

}  // namespace

std::vector<Plot> benchmark_plots(const BenchmarkResults& results) {
  std::vector<Plot> plots;
  add_scaling_plots(results, ScalingAxis::kSteps, plots);
  add_scaling_plots(results, ScalingAxis::kDof, plots);
  std::vector<ProfileLine> lines = performance_profiles(cost_table(results));
  std::erase_if(lines, [](const ProfileLine& line) { return line.ratios.empty(); });
  if (!lines.empty()) {
    plots.push_back(profile_plot(lines));
  }
  return plots;
}

void write_plots(const std::vector<Plot>& plots, const std::filesystem::path& folder) {
  for (const Plot& plot : plots) {
    scene::write_result_file(folder / (plot.name + ".dat"), plot.data);
    scene::write_result_file(folder / (plot.name + ".gp"), plot.script);
    run_gnuplot(folder, plot.name + ".gp");
  }
}

}  // namespace hbar::solver_benchmark
