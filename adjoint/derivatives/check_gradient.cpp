#include "hbar/adjoint/derivatives/check_gradient.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <random>
#include <sstream>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/probed_classes.h"
#include "hbar/adjoint/derivatives/smooth_piece.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/stop_flag.h"

namespace hbar {
namespace {

/// Flat view of inputs: p, then u step by step, then q0, then q̇0.
Eigen::VectorXd flatten(const Eigen::VectorXd& p, const Eigen::MatrixXd& u,
                        const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot0) {
  Eigen::VectorXd flat(p.size() + u.size() + q0.size() + qdot0.size());
  flat << p, u.reshaped(), q0, qdot0;
  return flat;
}

Inputs unflatten(const Inputs& shape, const Eigen::VectorXd& flat) {
  Inputs out = shape;
  Eigen::Index at = 0;
  const auto take = [&](auto&& part) {
    part = flat.segment(at, part.size());
    at += part.size();
  };
  take(out.p.reshaped());
  take(out.u.reshaped());
  take(out.q0.reshaped());
  take(out.qdot0.reshaped());
  return out;
}

Directions as_directions(const Horizon& horizon, const Inputs& shape, const Eigen::VectorXd& flat) {
  const Inputs parts = unflatten(shape, flat);
  Directions out = Directions::zero(horizon, 1);
  out.p.col(0) = parts.p;
  out.u.col(0) = parts.u.reshaped();
  out.q0.col(0) = parts.q0;
  out.qdot0.col(0) = parts.qdot0;
  return out;
}

/// Least-squares slope of log y over log x.
double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// State shared by all probes of one problem.
class Prober {
 public:
  Prober(const Problem& problem, const GradientCheckOptions& options)
      : problem_(problem),
        options_(options),
        horizon_(tightened(problem.horizon, true)),
        probing_(tightened(problem.horizon, false)),
        pieces_(horizon_),
        random_(options.seed) {
    trajectory_ = simulate(horizon_, problem.inputs).trajectory();
    const TrajectoryValues values = read_values(horizon_, trajectory_);
    partials_ = std::make_unique<TrajectoryPartials>(problem.objective.partials(values));
    value_ = problem.objective.value(values);
    AdjointSweep sweep(horizon_);
    const Gradient g = sweep.pull_back(trajectory_, *partials_);
    adjoint_norm_ = sweep.adjoint().norm();
    gradient_ = flatten(g.p, g.u, g.q0, g.qdot0);
    x_ = flatten(problem.inputs.p, problem.inputs.u, problem.inputs.q0, problem.inputs.qdot0);
    const double infinity = std::numeric_limits<double>::infinity();
    lower_ = Eigen::VectorXd::Constant(x_.size(), -infinity);
    upper_ = Eigen::VectorXd::Constant(x_.size(), infinity);
    lower_.head(problem.inputs.p.size()) = horizon_.parameters().lower();
    upper_.head(problem.inputs.p.size()) = horizon_.parameters().upper();
    piece_ = pieces_.read(trajectory_, values);
    tangent_ = std::make_unique<TangentSweep>(horizon_);
  }

  GradientCheckRow check(const ProbedClass& inputs) {
    GradientCheckRow row;
    row.name = inputs.name;
    row.size = static_cast<int>(inputs.entries.size());
    row.taylor_slope = std::numeric_limits<double>::infinity();
    row.remainder_vanishes = true;
    row.resolved = false;
    for (int i = 0; i < options_.directions; ++i) {
      probe(inputs, row);
    }
    // A wrong gradient leaves a remainder of first order. One of third order is that of a class
    // whose second derivative happens to be small.
    const bool slope_fits =
        row.remainder_vanishes || row.taylor_slope >= 2.0 - options_.slope_tolerance;
    row.passed = row.difference_gap <= options_.difference_bound && slope_fits &&
                 row.dot_gap <= options_.dot_bound;
    return row;
  }

 private:
  /// Factors are for the adjoint of the nominal trajectory, not for those of which Ψ is read.
  static Horizon tightened(const Horizon& horizon, bool with_factors) {
    SimulationOptions options = horizon.options();
    options.keep_factors = options.keep_factors && with_factors;
    options.newton.rtol = std::min(options.newton.rtol, 1e-13);
    return horizon.with(options);
  }

  /// Ψ; nothing where x is outside its bounds or on another smooth piece than the nominal inputs,
  /// or where the simulation fails.
  std::optional<double> value_at(const Eigen::VectorXd& x) {
    if ((x.array() < lower_.array()).any() || (x.array() > upper_.array()).any()) {
      return std::nullopt;
    }
    require_running(horizon_.options().stop, "gradient check interrupted");
    const Rollout rollout = simulate(probing_, unflatten(problem_.inputs, x));
    if (rollout.report().status == RolloutStatus::kStepFailed) {
      return std::nullopt;
    }
    const TrajectoryValues values = read_values(probing_, rollout.trajectory());
    if (pieces_.read(rollout.trajectory(), values) != piece_) {
      return std::nullopt;
    }
    return problem_.objective.value(values);
  }

  void probe(const ProbedClass& inputs, GradientCheckRow& row) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(x_.size());
    double class_norm = 0.0;
    for (std::size_t i = 0; i < inputs.entries.size(); ++i) {
      d[inputs.entries[i]] = inwards(inputs.entries[i], uniform(random_) * inputs.scales[i]);
      // Measured in the class's own typical sizes, so that a mass and a moment count equally.
      class_norm += std::pow(gradient_[inputs.entries[i]] * inputs.scales[i], 2);
    }
    class_norm = std::sqrt(class_norm);
    const double slope = gradient_.dot(d);
    // A class that Ψ hardly depends on is measured relative to Ψ: differences resolve no more.
    double scale = std::max(class_norm, 1e-4 * std::abs(value_));
    if (scale == 0.0) {
      scale = 1.0;  // at rest and at the optimum: absolute figures
    }
    row.dot_gap = std::max(row.dot_gap, dot_gap(d, slope, scale));
    differences(d, slope, scale, row);
  }

  /// The direction's entry, turned around where it leads out of bounds: 0 is the least of many
  /// coefficients, and the nominal value of some.
  [[nodiscard]] double inwards(Eigen::Index i, double d) const {
    const double reach = 2.0 * kLargestStep * std::abs(d);
    if (x_[i] - reach < lower_[i]) {
      return std::abs(d);
    }
    return x_[i] + reach > upper_[i] ? -std::abs(d) : d;
  }

  /// |⟨z̄, b⟩ − ⟨ȳ, H̄⁻¹ b⟩| over the larger of the two sides' norm products, b = ∂ḡ·d.
  double dot_gap(const Eigen::VectorXd& d, double slope, double scale) {
    const Directions directions = as_directions(horizon_, problem_.inputs, d);
    const Tangents tangents = tangent_->push_forward(trajectory_, directions);
    const double product = norm_product(*partials_, tangents);
    const double dual_product = adjoint_norm_ * tangent_->right_hand_sides().norm();
    const double forward = directional_derivative(*partials_, tangents, directions, 0);
    return std::abs(slope - forward) / std::max({scale, product, dual_product});
  }

  static constexpr double kLargestStep = 2e-2;

  /// What differences along one direction say.
  struct Differences {
    int taken = 0;  // steps on the smooth piece, with none larger in between that left it
    double largest_step = 0.0;
    double gap = std::numeric_limits<double>::infinity();  // of the best one
    std::vector<double> steps;                             // where the remainder is no rounding
    std::vector<double> remainders;
  };

  /// A difference quotient of second order and the Taylor remainder at one step.
  struct Quotient {
    double value = 0.0;
    double remainder = 0.0;
  };

  /// @param ahead  Ψ(x + step d)
  /// @param other  Ψ(x − step d) if central, else Ψ(x + 2 step d)
  [[nodiscard]] Quotient quotient(double ahead, double other, double slope, double step,
                                  bool central) const {
    const double remainder = std::abs(ahead - value_ - step * slope);
    if (central) {
      // The larger of both sides: one alone may change sign, where it has no order.
      return {(ahead - other) / (2.0 * step),
              std::max(remainder, std::abs(other - value_ + step * slope))};
    }
    return {(4.0 * ahead - 3.0 * value_ - other) / (2.0 * step), remainder};
  }

  /// Differences at steps from kLargestStep down, extrapolated once; the best one counts. The
  /// Taylor remainder is followed while it is well above rounding. Steps that leave the smooth
  /// piece of Ψ are replaced by smaller ones.
  Differences take(const Eigen::VectorXd& d, double slope, double rounding, bool central) {
    constexpr int kSteps = 12;
    constexpr double kSmallestStep = 1e-7;
    Differences out;
    double last = 0.0;
    // Twice a step ahead is where the step before was.
    std::optional<double> far = central ? std::nullopt : value_at(x_ + 2.0 * kLargestStep * d);
    for (double step = kLargestStep; out.taken < kSteps && step > kSmallestStep; step *= 0.5) {
      const std::optional<double> ahead = value_at(x_ + step * d);
      const std::optional<double> other = !central ? far
                                          : ahead  ? value_at(x_ - step * d)
                                                   : std::nullopt;
      far = ahead;
      if (!ahead || !other) {
        out = Differences();  // larger steps that returned to the piece have left it in between
        continue;
      }
      const Quotient found = quotient(*ahead, *other, slope, step, central);
      out.gap = std::min(out.gap, std::abs(found.value - slope));
      if (out.taken > 0) {
        out.gap = std::min(out.gap, std::abs((4.0 * found.value - last) / 3.0 - slope));
      } else {
        out.largest_step = step;
      }
      last = found.value;
      ++out.taken;
      if (found.remainder > 1e3 * rounding) {
        out.steps.push_back(step);
        out.remainders.push_back(found.remainder);
      }
    }
    return out;
  }

  /// Central differences where the smooth piece reaches to both sides; else those ahead or behind.
  void differences(const Eigen::VectorXd& d, double slope, double scale, GradientCheckRow& row) {
    const double rounding = 1e-13 * std::max(std::abs(value_), scale);
    Differences best = take(d, slope, rounding, true);
    if (best.taken < 4) {
      for (const double side : {1.0, -1.0}) {
        Differences one_sided = take(side * d, side * slope, rounding, false);
        if (one_sided.taken > best.taken) {
          best = std::move(one_sided);
        }
      }
    }
    // Differences of steps so small that rounding may be all of them confirm and refute nothing.
    if (best.taken == 0 ||
        (best.gap > options_.difference_bound * scale && best.gap * best.largest_step < rounding)) {
      return;
    }
    row.resolved = true;
    row.difference_gap = std::max(row.difference_gap, best.gap / scale);
    if (best.steps.size() >= 4) {
      // The smallest half of the steps: the asymptotic part.
      const auto tail =
          static_cast<std::ptrdiff_t>(std::max<std::size_t>(4, best.steps.size() / 2));
      const double order = log_slope({best.steps.end() - tail, best.steps.end()},
                                     {best.remainders.end() - tail, best.remainders.end()});
      row.remainder_vanishes = false;
      row.taylor_slope = std::min(row.taylor_slope, order);
    }
  }

  const Problem& problem_;
  const GradientCheckOptions& options_;
  Horizon horizon_;
  Horizon probing_;  // the same, keeping no factors
  SmoothPieceReader pieces_;
  std::mt19937 random_;
  double value_ = 0.0;
  double adjoint_norm_ = 0.0;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd x_, lower_, upper_;
  Trajectory trajectory_;
  std::vector<int> piece_;
  std::unique_ptr<TrajectoryPartials> partials_;
  std::unique_ptr<TangentSweep> tangent_;
};

}  // namespace

bool GradientCheckReport::passed() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const GradientCheckRow& row) { return row.passed; });
}

std::vector<std::string> GradientCheckReport::unresolved() const {
  std::vector<std::string> names;
  for (const GradientCheckRow& row : rows) {
    if (!row.resolved) {
      names.push_back(row.name);
    }
  }
  return names;
}

std::string GradientCheckReport::table() const {
  std::ostringstream out;
  out << std::left << std::setw(28) << "class" << std::right << std::setw(6) << "size"
      << std::setw(14) << "differences" << std::setw(12) << "slope" << std::setw(14)
      << "dot product"
      << "  verdict\n";
  for (const GradientCheckRow& row : rows) {
    out << std::left << std::setw(28) << row.name << std::right << std::setw(6) << row.size
        << std::scientific << std::setprecision(1) << std::setw(14);
    if (row.resolved) {
      out << row.difference_gap;
    } else {
      out << "none";
    }
    if (!row.resolved) {
      out << std::setw(12) << "none";
    } else if (row.remainder_vanishes) {
      out << std::setw(12) << "affine";
    } else {
      out << std::fixed << std::setprecision(3) << std::setw(12) << row.taylor_slope;
    }
    out << std::scientific << std::setprecision(1) << std::setw(14) << row.dot_gap
        << (!row.passed    ? "  FAILED\n"
            : row.resolved ? "  ok\n"
                           : "  no smooth piece around it\n");
  }
  return out.str();
}

GradientCheckReport check_gradient(const Problem& problem, const GradientCheckOptions& options) {
  Prober prober(problem, options);
  GradientCheckReport report;
  for (const ProbedClass& inputs : probed_classes(problem)) {
    report.rows.push_back(prober.check(inputs));
  }
  return report;
}

}  // namespace hbar
