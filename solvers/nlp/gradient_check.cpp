#include "hbar/solvers/nlp/gradient_check.h"

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace hbar::solvers {
namespace {

constexpr std::array kDifferenceSteps = {1e-4, 1e-5, 1e-6};
constexpr std::array kTaylorSteps = {1e-2, 1e-3, 1e-4};
// Rounding of a value, in units of its size: what a simulation of many steps may accumulate.
constexpr double kValueRounding = 1e-14;

/// All outputs of a program as one function F(x) = (f, c) with a dense derivative.
class Outputs {
 public:
  Outputs(Nlp& nlp, const Eigen::VectorXd& x) : nlp_(nlp), x_(x) {
    const NlpVariables& v = nlp.variables();
    if (x.size() != v.start.size()) {
      throw InvalidInput(
          concat("check_gradients: x has ", x.size(), " entries; expected ", v.start.size()));
    }
    scale_ = v.scale.size() > 0 ? v.scale : Eigen::VectorXd(Eigen::VectorXd::Ones(x.size()));
    value_ = value(x);
    derivative_.setZero(value_.size(), x.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    nlp.objective_gradient(x, gradient);
    derivative_.row(0) = gradient.transpose();
    const SparsityPattern& pattern = nlp.jacobian_pattern();
    Eigen::VectorXd entries = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pattern.rows.size()));
    if (value_.size() > 1) {
      nlp.constraint_jacobian(x, entries);
    }
    for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
      derivative_(pattern.rows[k] + 1, pattern.columns[k]) += entries[static_cast<Eigen::Index>(k)];
    }
  }

  [[nodiscard]] const Eigen::VectorXd& scale() const { return scale_; }
  [[nodiscard]] const Eigen::VectorXd& value() const { return value_; }
  [[nodiscard]] Eigen::Index size() const { return value_.size(); }
  [[nodiscard]] Eigen::VectorXd slope(const Eigen::VectorXd& d) const { return derivative_ * d; }
  /// Largest derivative of an output with respect to a scaled variable.
  [[nodiscard]] double steepness(Eigen::Index output) const {
    return derivative_.row(output).cwiseProduct(scale_.transpose()).lpNorm<Eigen::Infinity>();
  }
  [[nodiscard]] std::string name(Eigen::Index output) const {
    return output == 0 ? "objective"
                       : nlp_.constraint_limits().names[static_cast<std::size_t>(output - 1)];
  }

  /// F(x + d), or nothing where it cannot be evaluated.
  [[nodiscard]] std::optional<Eigen::VectorXd> at_step(const Eigen::VectorXd& d) {
    try {
      Eigen::VectorXd result = value(x_ + d);
      if (result.allFinite()) {
        return result;
      }
    } catch (const EvaluationError&) {
      // Skipped: the caller continues with the other steps.
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Eigen::VectorXd value(const Eigen::VectorXd& x) {
    const Eigen::Index m = nlp_.constraint_limits().lower.size();
    Eigen::VectorXd c = Eigen::VectorXd::Zero(m);
    Eigen::VectorXd result(m + 1);
    result[0] = nlp_.objective(x);
    if (m > 0) {
      nlp_.constraints(x, c);
    }
    result.tail(m) = c;
    return result;
  }

  Nlp& nlp_;
  Eigen::VectorXd x_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd value_;       // [1 + m]
  Eigen::MatrixXd derivative_;  // [1 + m x n]
};

void check_differences(Outputs& F, const Eigen::VectorXd& d, const std::string& where,
                       GradientCheck& report) {
  const Eigen::VectorXd slope = F.slope(d);
  Eigen::VectorXd gap =
      Eigen::VectorXd::Constant(F.size(), std::numeric_limits<double>::infinity());
  bool any_step = false;
  for (const double step : kDifferenceSteps) {
    const auto above = F.at_step(step * d);
    const auto below = F.at_step(-step * d);
    if (!above || !below) {
      continue;
    }
    any_step = true;
    for (Eigen::Index i = 0; i < F.size(); ++i) {
      const double difference = ((*above)[i] - (*below)[i]) / (2.0 * step);
      const double size = std::max(std::abs((*above)[i]), std::abs((*below)[i]));
      const double excess = std::abs(difference - slope[i]) - kValueRounding * size / step;
      const double scale = std::max(F.steepness(i), std::abs(difference));
      gap[i] = std::min(gap[i], excess > 0.0 ? excess / scale : 0.0);
    }
  }
  if (!any_step) {
    throw EvaluationError(concat("check_gradients: no step ", where, " can be evaluated"));
  }
  for (Eigen::Index i = 0; i < F.size(); ++i) {
    if (std::isnan(slope[i])) {
      gap[i] = std::numeric_limits<double>::infinity();
    }
    if (gap[i] <= report.gap) {
      continue;
    }
    report.gap = gap[i];
    report.gap_name = concat(F.name(i), " ", where);
  }
}

void check_remainder(Outputs& F, const Eigen::VectorXd& d, const std::string& where,
                     GradientCheck& report) {
  const Eigen::VectorXd slope = F.slope(d);
  // Each pair of neighbouring steps whose remainders are well above rounding gives an order; the
  // last one counts, being closest to the limit.
  Eigen::VectorXd order =
      Eigen::VectorXd::Constant(F.size(), std::numeric_limits<double>::infinity());
  Eigen::VectorXd previous;
  double previous_step = 0.0;
  for (const double step : kTaylorSteps) {
    const auto value = F.at_step(step * d);
    if (!value) {
      continue;
    }
    const Eigen::VectorXd remainder = (*value - F.value() - step * slope).cwiseAbs();
    for (Eigen::Index i = 0; i < F.size() && previous_step > 0.0; ++i) {
      const double rounding = kValueRounding * (std::abs(F.value()[i]) + step * F.steepness(i));
      if (remainder[i] > 100.0 * rounding) {
        order[i] = std::log(previous[i] / remainder[i]) / std::log(previous_step / step);
      }
    }
    previous = remainder;
    previous_step = step;
  }
  for (Eigen::Index i = 0; i < F.size(); ++i) {
    if (order[i] >= report.slope) {
      continue;
    }
    report.slope = order[i];
    report.slope_name = concat(F.name(i), " ", where);
  }
}

}  // namespace

GradientCheck check_gradients(Nlp& nlp, const Eigen::VectorXd& x,
                              const GradientCheckOptions& options) {
  validate(nlp);
  Outputs F(nlp, x);
  GradientCheck report;
  std::mt19937_64 engine(options.seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < options.directions; ++k) {
    Eigen::VectorXd d = F.scale();
    for (double& entry : d) {
      entry *= uniform(engine);
    }
    const std::string where = concat("along direction ", k);
    check_differences(F, d, where, report);
    check_remainder(F, d, where, report);
  }
  for (Eigen::Index i = 0; options.coordinates && i < x.size(); ++i) {
    const Eigen::VectorXd d = F.scale()[i] * Eigen::VectorXd::Unit(x.size(), i);
    const std::string& name = nlp.variables().names[static_cast<std::size_t>(i)];
    check_differences(F, d, "by " + name, report);
  }
  return report;
}

}  // namespace hbar::solvers
