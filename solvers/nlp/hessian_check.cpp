#include "hbar/solvers/nlp/hessian_check.h"

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace hbar::solvers {
namespace {

constexpr std::array kGradientSteps = {1e-4, 1e-5, 1e-6};
constexpr std::array kModelSteps = {1e-2, 1e-3, 1e-4};
// Rounding of a gradient's entry or of a value, in units of its size.
constexpr double kRounding = 1e-14;

/// L = σ f + λᵀ c about a point.
class Lagrangian {
 public:
  Lagrangian(Nlp& nlp, const Eigen::VectorXd& x, std::mt19937_64& engine) : nlp_(nlp), x_(x) {
    const NlpVariables& v = nlp.variables();
    if (x.size() != v.start.size()) {
      throw InvalidInput(
          concat("check_hessian: x has ", x.size(), " entries; expected ", v.start.size()));
    }
    scale_ = v.scale.size() > 0 ? v.scale : Eigen::VectorXd(Eigen::VectorXd::Ones(x.size()));
    const NlpConstraints& limits = nlp.constraint_limits();
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    sigma_ = 1.0 + 0.5 * uniform(engine);
    lambda_.resize(limits.lower.size());
    for (double& multiplier : lambda_) {
      multiplier = uniform(engine);
    }
    if (limits.scale.size() > 0) {
      lambda_ = lambda_.cwiseQuotient(limits.scale);
    }
    read_hessian();
    value_ = value(x);
    gradient_ = gradient(x);
    if (!std::isfinite(value_) || !gradient_.allFinite() || !hessian_.allFinite()) {
      throw EvaluationError("check_hessian: a value or derivative at x is not finite");
    }
  }

  [[nodiscard]] const Eigen::VectorXd& scale() const { return scale_; }
  [[nodiscard]] Eigen::VectorXd product(const Eigen::VectorXd& d) const { return hessian_ * d; }
  /// Largest derivative of a gradient's entry with respect to a scaled variable.
  [[nodiscard]] double steepness(Eigen::Index i) const {
    return hessian_.row(i).cwiseProduct(scale_.transpose()).lpNorm<Eigen::Infinity>();
  }
  [[nodiscard]] double size() const { return size_; }

  /// ∇L(x + d), or nothing where it cannot be evaluated.
  [[nodiscard]] std::optional<Eigen::VectorXd> gradient_at(const Eigen::VectorXd& d) {
    try {
      Eigen::VectorXd result = gradient(x_ + d);
      if (result.allFinite()) {
        return result;
      }
    } catch (const EvaluationError&) {
      // Skipped: the caller continues with the other steps.
    }
    return std::nullopt;
  }

  /// |L(x + d) − L − ∇Lᵀd − dᵀHd/2|, or nothing where it cannot be evaluated.
  [[nodiscard]] std::optional<double> remainder(const Eigen::VectorXd& d) {
    try {
      const double gap =
          std::abs(value(x_ + d) - value_ - gradient_.dot(d) - 0.5 * d.dot(product(d)));
      if (std::isfinite(gap)) {
        return gap;
      }
    } catch (const EvaluationError&) {
      // As above.
    }
    return std::nullopt;
  }

 private:
  void read_hessian() {
    const SparsityPattern& pattern = nlp_.hessian_pattern(HessianKind::kExact);
    Eigen::VectorXd entries = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pattern.rows.size()));
    nlp_.lagrangian_hessian(x_, sigma_, lambda_, HessianKind::kExact, entries);
    hessian_.setZero(x_.size(), x_.size());
    for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
      const int row = pattern.rows[k];
      const int column = pattern.columns[k];
      hessian_(row, column) += entries[static_cast<Eigen::Index>(k)];
      if (row != column) {
        hessian_(column, row) += entries[static_cast<Eigen::Index>(k)];
      }
    }
  }

  /// L, and in size_ the size of its terms.
  double value(const Eigen::VectorXd& x) {
    Eigen::VectorXd c = Eigen::VectorXd::Zero(lambda_.size());
    const double f = sigma_ * nlp_.objective(x);
    if (c.size() > 0) {
      nlp_.constraints(x, c);
    }
    size_ = std::abs(f) + lambda_.cwiseProduct(c).lpNorm<1>();
    return f + lambda_.dot(c);
  }

  Eigen::VectorXd gradient(const Eigen::VectorXd& x) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(x.size());
    nlp_.objective_gradient(x, result);
    result *= sigma_;
    const SparsityPattern& pattern = nlp_.jacobian_pattern();
    Eigen::VectorXd entries = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pattern.rows.size()));
    if (lambda_.size() > 0) {
      nlp_.constraint_jacobian(x, entries);
    }
    for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
      result[pattern.columns[k]] +=
          entries[static_cast<Eigen::Index>(k)] * lambda_[pattern.rows[k]];
    }
    return result;
  }

  Nlp& nlp_;
  Eigen::VectorXd x_;
  Eigen::VectorXd scale_;
  double sigma_ = 1.0;
  Eigen::VectorXd lambda_;
  double value_ = 0.0;
  double size_ = 0.0;
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd hessian_;
};

void check_products(Lagrangian& L, const Eigen::VectorXd& d, const std::string& where,
                    const std::vector<std::string>& names, HessianCheck& report) {
  const Eigen::VectorXd product = L.product(d);
  Eigen::VectorXd gap =
      Eigen::VectorXd::Constant(d.size(), std::numeric_limits<double>::infinity());
  bool any_step = false;
  for (const double step : kGradientSteps) {
    const auto above = L.gradient_at(step * d);
    const auto below = L.gradient_at(-step * d);
    if (!above || !below) {
      continue;
    }
    any_step = true;
    // An entry may be what is left of larger terms: rounding is measured by the whole gradient.
    const double size = above->cwiseProduct(L.scale()).lpNorm<Eigen::Infinity>();
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      const double difference = ((*above)[i] - (*below)[i]) / (2.0 * step);
      const double excess =
          std::abs(difference - product[i]) - kRounding * size / (L.scale()[i] * step);
      const double scale = std::max(L.steepness(i), std::abs(difference));
      gap[i] = std::min(gap[i], excess > 0.0 ? excess / scale : 0.0);
    }
  }
  if (!any_step) {
    throw EvaluationError(concat("check_hessian: no step ", where, " can be evaluated"));
  }
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    if (gap[i] <= report.gap) {
      continue;
    }
    report.gap = gap[i];
    report.gap_name = concat(names[static_cast<std::size_t>(i)], " ", where);
  }
}

void check_model(Lagrangian& L, const Eigen::VectorXd& d, const std::string& name,
                 HessianCheck& report) {
  // As for gradients: the last pair of steps whose remainders are well above rounding counts.
  double order = std::numeric_limits<double>::infinity();
  double previous = 0.0;
  double previous_step = 0.0;
  for (const double step : kModelSteps) {
    const auto remainder = L.remainder(step * d);
    if (!remainder) {
      continue;
    }
    if (previous_step > 0.0 && *remainder > 100.0 * kRounding * L.size()) {
      order = std::log(previous / *remainder) / std::log(previous_step / step);
    }
    previous = *remainder;
    previous_step = step;
  }
  if (order >= report.slope) {
    return;
  }
  report.slope = order;
  report.slope_name = name;
}

}  // namespace

HessianCheck check_hessian(Nlp& nlp, const Eigen::VectorXd& x,
                           const GradientCheckOptions& options) {
  validate(nlp);
  validate_hessian(nlp, HessianKind::kExact);
  std::mt19937_64 engine(options.seed);
  Lagrangian L(nlp, x, engine);
  const std::vector<std::string>& names = nlp.variables().names;
  HessianCheck report;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < options.directions; ++k) {
    Eigen::VectorXd d = L.scale();
    for (double& entry : d) {
      entry *= uniform(engine);
    }
    check_products(L, d, concat("along direction ", k), names, report);
    check_model(L, d, concat("direction ", k), report);
  }
  for (Eigen::Index i = 0; options.coordinates && i < x.size(); ++i) {
    const Eigen::VectorXd d = L.scale()[i] * Eigen::VectorXd::Unit(x.size(), i);
    check_products(L, d, "by " + names[static_cast<std::size_t>(i)], names, report);
  }
  return report;
}

}  // namespace hbar::solvers
