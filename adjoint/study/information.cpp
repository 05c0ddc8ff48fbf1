#include "hbar/adjoint/study/information.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::study {
namespace {

void check_vector(const Eigen::VectorXd& v, Eigen::Index size, const char* what) {
  if (v.size() != size) {
    throw InvalidInput(concat("information: ", what, " has ", v.size(), " entries, not ", size));
  }
  if (!v.allFinite()) {
    throw InvalidInput(concat("information: ", what, " is not finite"));
  }
}

void check_fit(const Fit& fit) {
  const auto k = static_cast<Eigen::Index>(fit.names.size());
  const Eigen::Index data = fit.residual.size();
  check_vector(fit.estimate, k, "estimate");
  check_vector(fit.scale, k, "scale");
  check_vector(fit.residual, data, "residual");
  check_vector(fit.sigma, data, "sigma");
  if (fit.sensitivity.rows() != data || fit.sensitivity.cols() != k ||
      !fit.sensitivity.allFinite()) {
    throw InvalidInput(concat("information: sensitivity is ", fit.sensitivity.rows(), " x ",
                              fit.sensitivity.cols(), ", not ", data, " x ", k, " finite numbers"));
  }
  if (k == 0) {
    throw InvalidInput("information: there are no parameters");
  }
  if ((fit.scale.array() <= 0.0).any()) {
    throw InvalidInput("information: a scale is not positive");
  }
  if ((fit.sigma.array() <= 0.0).any()) {
    throw InvalidInput("information: a sigma is not positive");
  }
}

/// A direction as a sum of names, without its negligible parts: "0.8 mass - 0.6 stiffness".
std::string direction_words(const Eigen::VectorXd& direction,
                            const std::vector<std::string>& names) {
  constexpr double kNegligible = 0.01;
  Eigen::Index largest = 0;
  const double size = direction.cwiseAbs().maxCoeff(&largest);
  const double sign = direction[largest] < 0.0 ? -1.0 : 1.0;
  std::string words;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    const double part = sign * direction[i];
    if (std::abs(part) < kNegligible * size) {
      continue;
    }
    if (!words.empty()) {
      words += part < 0.0 ? " - " : " + ";
    } else if (part < 0.0) {
      words += "-";
    }
    if (std::abs(part) < 0.995) {
      words += scene::format_number(std::round(100.0 * std::abs(part)) / 100.0) + ' ';
    }
    words += names[static_cast<std::size_t>(i)];
  }
  return words;
}

void tell_silent_directions(Information& out) {
  out.message = "the data say nothing of ";
  for (Eigen::Index i = 0; i < out.silent.cols(); ++i) {
    out.message += (i == 0 ? "" : "; nor of ") + direction_words(out.silent.col(i), out.names);
  }
  out.message +=
      " (in units of scale): measure what answers to it, or hold one of these parameters";
}

void add_intervals(Information& out, double level) {
  out.standard_deviations = out.covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = out.standard_deviations.cwiseInverse();
  out.correlation = inverse.asDiagonal() * out.covariance * inverse.asDiagonal();
  out.correlation.diagonal().setOnes();
  const double z = normal_quantile(level);
  out.lower = out.estimate - z * out.standard_deviations;
  out.upper = out.estimate + z * out.standard_deviations;
}

}  // namespace

double normal_quantile(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw InvalidInput(concat("normal_quantile: the level ", level, " is outside (0, 1)"));
  }
  // Newton's method on erf(z/√2) = level, which is concave: from 0 it rises to the root.
  constexpr double kSlopeAtZero = std::numbers::sqrt2 * std::numbers::inv_sqrtpi;
  double z = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double missing = std::erfc(z / std::numbers::sqrt2) - (1.0 - level);
    const double step = missing / (kSlopeAtZero * std::exp(-0.5 * z * z));
    z += step;
    if (std::abs(step) <= 1e-15 * z) {
      break;
    }
  }
  return z;
}

Information information(const Fit& fit, const InformationOptions& options) {
  check_fit(fit);
  const Eigen::Index data = fit.residual.size();
  const auto k = static_cast<Eigen::Index>(fit.names.size());
  Information out;
  out.names = fit.names;
  out.estimate = fit.estimate;
  out.chi_square = fit.residual.cwiseQuotient(fit.sigma).squaredNorm();
  out.degrees_of_freedom = data - k;
  if (options.scale_by_residual) {
    if (out.degrees_of_freedom < 1) {
      throw InvalidInput(concat("information: sigma cannot be estimated from ", data, " data with ",
                                k, " parameters"));
    }
    out.sigma_factor = std::sqrt(out.chi_square / static_cast<double>(out.degrees_of_freedom));
  }

  const Eigen::MatrixXd weighted = fit.sigma.cwiseInverse().asDiagonal() * fit.sensitivity;
  out.fisher = weighted.transpose() * weighted;

  // Columns of equal length make the result independent of the parameters' units; one that is only
  // rounding relative to the others stays short, and so counts as silent.
  const Eigen::VectorXd lengths = (weighted * fit.scale.asDiagonal()).colwise().norm().transpose();
  const double longest = data == 0 ? 0.0 : lengths.maxCoeff();
  Eigen::VectorXd unit = fit.scale;
  for (Eigen::Index i = 0; i < k; ++i) {
    const bool answers = lengths[i] > options.least_answer * longest;
    unit[i] /= answers ? lengths[i] : std::max(longest, 1.0);
  }
  Eigen::MatrixXd even = Eigen::MatrixXd::Zero(std::max(data, k), k);
  even.topRows(data) = weighted * unit.asDiagonal();
  const Eigen::MatrixXd R = Eigen::HouseholderQR<Eigen::MatrixXd>(even)
                                .matrixQR()
                                .topRows(k)
                                .triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(R, Eigen::ComputeFullV);
  const Eigen::VectorXd& answers = svd.singularValues();
  Eigen::Index known = 0;
  while (known < k && answers[known] > options.least_answer * std::max(answers[0], 1e-300)) {
    ++known;
  }
  if (known < k) {
    out.silent = unit.cwiseQuotient(fit.scale).asDiagonal() * svd.matrixV().rightCols(k - known);
    out.silent.colwise().normalize();
    tell_silent_directions(out);
    return out;
  }
  const Eigen::MatrixXd root =
      unit.asDiagonal() * svd.matrixV() * answers.cwiseInverse().asDiagonal();
  out.covariance = (out.sigma_factor * out.sigma_factor) * root * root.transpose();
  add_intervals(out, options.level);
  return out;
}

}  // namespace hbar::study
