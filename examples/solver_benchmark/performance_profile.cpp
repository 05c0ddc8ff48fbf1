#include "performance_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hbar::solver_benchmark {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

bool tried(double cost) { return cost >= 0.0; }

/// The least cost of a row, of all columns but one (−1: of all).
double best(const std::vector<double>& row, std::size_t without) {
  double least = kNone;
  for (std::size_t s = 0; s < row.size(); ++s) {
    if (s != without && tried(row[s])) {
      least = std::min(least, row[s]);
    }
  }
  return least;
}

double geometric_mean(const std::vector<double>& numbers) {
  double sum = 0.0;
  for (const double number : numbers) {
    sum += std::log(number);
  }
  return numbers.empty() ? 0.0 : std::exp(sum / static_cast<double>(numbers.size()));
}

constexpr std::size_t kEvery = std::numeric_limits<std::size_t>::max();

}  // namespace

double ProfileLine::share(double ratio) const {
  const auto count = std::upper_bound(ratios.begin(), ratios.end(), ratio) - ratios.begin();
  return matrices == 0 ? 0.0 : static_cast<double>(count) / matrices;
}

std::vector<ProfileLine> performance_profiles(const CostTable& table) {
  std::vector<ProfileLine> lines;
  for (std::size_t s = 0; s < table.solvers.size(); ++s) {
    ProfileLine line{.solver = table.solvers[s]};
    for (const std::vector<double>& row : table.costs) {
      const double least = best(row, kEvery);
      if (!tried(row[s]) || least == kNone) {
        continue;
      }
      ++line.matrices;
      if (row[s] < kNone) {
        line.ratios.push_back(row[s] / least);
        line.wins += row[s] == least ? 1 : 0;
      }
    }
    std::sort(line.ratios.begin(), line.ratios.end());
    line.mean = geometric_mean(line.ratios);
    lines.push_back(std::move(line));
  }
  return lines;
}

double mean_ratio_to_best_other(const CostTable& table, const std::string& solver) {
  const auto place = std::find(table.solvers.begin(), table.solvers.end(), solver);
  const auto s = static_cast<std::size_t>(place - table.solvers.begin());
  std::vector<double> ratios;
  for (const std::vector<double>& row : table.costs) {
    if (s < row.size() && tried(row[s])) {
      const double least = best(row, s);
      if (least < kNone) {
        ratios.push_back(row[s] / least);
      }
    }
  }
  return geometric_mean(ratios);
}

}  // namespace hbar::solver_benchmark
