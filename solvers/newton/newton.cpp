#include "hbar/solvers/newton/newton.h"

#include <algorithm>
#include <cmath>

namespace hbar::solvers {
namespace {

/// Corrections this small that no longer shrink are rounding.
constexpr double kRoundingCorrection = 1e-9;

}  // namespace

std::string_view describe(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::kConverged:
      return "converged";
    case NewtonStatus::kRounding:
      return "converged to rounding";
    case NewtonStatus::kIterationLimit:
      return "iteration limit reached";
    case NewtonStatus::kLineSearch:
      return "line search stalled";
    case NewtonStatus::kSingular:
      return "singular Jacobian";
    case NewtonStatus::kNotFinite:
      return "residual not finite";
    case NewtonStatus::kStrayed:
      return "converged to a root far from the prediction";
  }
  return "";
}

Newton::Newton(Eigen::Index size) : g_(size), dx_(size), next_(size), simplified_(size) {}

double Newton::measure(const Eigen::VectorXd& dx, const Eigen::VectorXd& x, int* worst) const {
  double length = 0.0;
  for (Eigen::Index i = 0; i < dx.size(); ++i) {
    const double entry = std::abs(dx[i]) / (1.0 + std::abs(x[i]));
    if (!(entry <= length)) {  // NaN counts as worst
      length = entry;
      *worst = static_cast<int>(i);
      if (std::isnan(entry)) {
        return entry;
      }
    }
  }
  return length;
}

Newton::Search Newton::search(NewtonSystem& system, const NewtonOptions& options,
                              const Eigen::VectorXd& x, NewtonReport& report, double& lambda) {
  for (int trial = 0; trial <= options.max_ls; ++trial) {
    next_ = x + lambda * dx_;
    system.residual(next_, g_);
    double predicted = 0.1 * lambda;
    if (g_.allFinite()) {
      system.solve(g_, simplified_);
      simplified_ = -simplified_;
      int worst = 0;
      // Both corrections measured at x: else a runaway iterate would look like progress.
      simplified_length_ = measure(simplified_, x, &worst);
      if (simplified_length_ <= std::max((1.0 - 0.25 * lambda) * length_, options.rtol)) {
        report.residual = g_.norm();
        return Search::kAccepted;
      }
      // The step that a quadratic model of the curvature along dx would take.
      const double bend = (simplified_ - (1.0 - lambda) * dx_).cwiseAbs().maxCoeff();
      predicted = 0.5 * dx_.cwiseAbs().maxCoeff() * lambda * lambda / bend;
    }
    lambda = std::clamp(predicted, 0.1 * lambda, 0.5 * lambda);
  }
  return Search::kFailed;
}

bool Newton::polish(NewtonSystem& system, const NewtonOptions& options, Eigen::VectorXd& x,
                    NewtonReport& report) {
  double ratio = simplified_length_ / length_;
  while (report.iterations < options.max_iter) {
    const double length = simplified_length_;
    const bool small = length <= options.rtol;
    // Worth it if two more corrections at this rate suffice; else a new Jacobian is cheaper.
    if (!small && (ratio > 0.1 || length * ratio * ratio > options.rtol)) {
      return false;
    }
    x += simplified_;
    ++report.iterations;
    report.correction = length;
    if (small && report.residual <= options.tol) {
      report.status = NewtonStatus::kConverged;
      return true;
    }
    system.residual(x, g_);
    report.residual = g_.norm();
    system.solve(g_, simplified_);
    simplified_ = -simplified_;
    simplified_length_ = measure(simplified_, x, &report.worst);
    if (!std::isfinite(simplified_length_)) {
      return false;
    }
    ratio = simplified_length_ / length;
    if (ratio > 0.5 && length <= kRoundingCorrection) {
      report.status = report.residual <= options.tol && length <= options.rtol
                          ? NewtonStatus::kConverged
                          : NewtonStatus::kRounding;
      return true;
    }
  }
  return false;
}

NewtonReport Newton::solve(NewtonSystem& system, const NewtonOptions& options, Eigen::VectorXd& x) {
  NewtonReport report;
  double lambda = 1.0;
  while (true) {
    system.factorize(x, g_);
    ++report.factorizations;
    report.residual = g_.norm();
    if (!std::isfinite(report.residual)) {
      report.status = NewtonStatus::kNotFinite;
      return report;
    }
    system.solve(g_, dx_);
    dx_ = -dx_;
    length_ = measure(dx_, x, &report.worst);
    if (!std::isfinite(length_)) {
      report.status = NewtonStatus::kSingular;
      return report;
    }
    lambda = 1.0;
    if (search(system, options, x, report, lambda) == Search::kFailed) {
      const bool rounding = length_ <= kRoundingCorrection;
      report.correction = length_;
      report.status = rounding ? NewtonStatus::kRounding : NewtonStatus::kLineSearch;
      return report;
    }
    x = next_;
    ++report.iterations;
    report.correction = length_;
    if (lambda == 1.0 && polish(system, options, x, report)) {
      return report;
    }
    if (report.iterations >= options.max_iter) {
      report.status = NewtonStatus::kIterationLimit;
      return report;
    }
  }
}

}  // namespace hbar::solvers
