#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace hbar::identify {
namespace {

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

std::string correlation_lines(const study::Information& known) {
  std::string text = "correlation:\n";
  for (Eigen::Index i = 0; i < known.correlation.rows(); ++i) {
    fmt::format_to(std::back_inserter(text), "  {:<22}", known.names[at(i)]);
    for (Eigen::Index j = 0; j <= i; ++j) {
      fmt::format_to(std::back_inserter(text), " {:>6.3f}", known.correlation(i, j));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string estimate_table(const study::Information& known, const DesignVariables& unknowns,
                           const Eigen::VectorXd& truth) {
  const bool complete = known.complete();
  std::string text = fmt::format("{:<22} {:>9} {:>9} {:>10} {:>10} {:>10} {:>10}  {}\n", "unknown",
                                 "truth", "start", "estimate", "std. dev.", "95 % from", "to",
                                 truth.size() > 0 && complete ? "holds truth" : "");
  for (Eigen::Index i = 0; i < known.estimate.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:<22} {:>9} {:>9.5f} {:>10.6f}", known.names[at(i)],
                   truth.size() > 0 ? fmt::format("{:.5f}", truth[i]) : "?", unknowns.start[i],
                   known.estimate[i]);
    if (complete) {
      fmt::format_to(std::back_inserter(text), " {:>10.6f} {:>10.6f} {:>10.6f}",
                     known.standard_deviations[i], known.lower[i], known.upper[i]);
      if (truth.size() > 0) {
        text += known.lower[i] <= truth[i] && truth[i] <= known.upper[i] ? "  yes" : "  no";
      }
    }
    text += fmt::format(" {}\n", unknowns.units[at(i)]);
  }
  text += complete ? correlation_lines(known)
                   : fmt::format("no standard deviations: {}\n", known.message);
  const auto freedom = static_cast<double>(known.degrees_of_freedom);
  return text + fmt::format(
                    "chi square: {:.2f} for {} degrees of freedom: {:.4f} each, expected 1 "
                    "+- {:.4f}\n",
                    known.chi_square, known.degrees_of_freedom, known.chi_square / freedom,
                    std::sqrt(2.0 / freedom));
}

std::string ways_table(const std::vector<Way>& ways, const Eigen::VectorXd& deviations) {
  std::string text =
      fmt::format("{:<22} {:>6} {:>5} {:>5} {:>5} {:>9} {:>16} {:>12}\n", "fitted by", "iter.", "f",
                  "df", "ddf", "time", "objective", "apart");
  for (const Way& way : ways) {
    const double apart =
        (way.unknowns - ways.front().unknowns).cwiseQuotient(deviations).lpNorm<Eigen::Infinity>();
    text +=
        fmt::format("{:<22} {:>6} {:>5} {:>5} {:>5} {:>7.3f} s {:>16.9f} {:>7.1e} sd{}\n", way.name,
                    way.iterations < 0 ? "-" : std::to_string(way.iterations),
                    way.evaluations.objective, way.evaluations.gradient, way.evaluations.hessian,
                    way.seconds, way.objective, apart, way.converged ? "" : "  not converged");
  }
  return text;
}

std::string coverage_table(const Coverage& coverage, const std::vector<std::string>& names) {
  std::string text = fmt::format("{:<22} {:>12} {:>12} {:>12} {:>10}\n", "unknown", "bias",
                                 "scatter", "predicted", "covered");
  for (Eigen::Index i = 0; i < coverage.bias.size(); ++i) {
    text += fmt::format("{:<22} {:>12.3e} {:>12.3e} {:>12.3e} {:>8.1f} %\n", names[at(i)],
                        coverage.bias[i], coverage.scatter[i], coverage.predicted[i],
                        100.0 * coverage.covered[i]);
  }
  return text + fmt::format(
                    "{} fits; 95 % of the intervals should hold the truth, +- {:.1f} % for "
                    "so many; mean chi square {:.2f}\n",
                    coverage.fits,
                    100.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(coverage.fits)),
                    coverage.chi_square);
}

}  // namespace hbar::identify
