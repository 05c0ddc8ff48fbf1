#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hbar::study {

/// A model's response to its parameters near an estimate: the result of a fit.
struct Fit {
  std::vector<std::string> names;  ///< of the parameters                                [k]
  Eigen::VectorXd estimate;        ///< of the parameters                                [k]
  Eigen::VectorXd scale;           ///< typical size > 0 of a change of each             [k]
  Eigen::MatrixXd sensitivity;  ///< ∂value/∂parameter                                [data x k]
  Eigen::VectorXd residual;     ///< value − datum                                    [data]
  Eigen::VectorXd sigma;        ///< standard deviation > 0 of each datum             [data]
};

/// Options of information().
struct InformationOptions {
  double level = 0.95;  ///< of confidence intervals, in (0, 1)
  /// Standard deviations of the data are known up to a common factor, which is estimated from the
  /// residual.
  bool scale_by_residual = false;
  /// A direction counts as unobservable if the response to it is smaller than this, relative to the
  /// best-known direction.
  double least_answer = 1e-8;
};

/// What data tell about parameters, to first order: if the data scatter normally about the model,
/// the estimate scatters with the covariance F⁻¹.
struct Information {
  std::vector<std::string> names;  ///<                                                  [k]
  Eigen::VectorXd estimate;        ///<                                                  [k]
  Eigen::MatrixXd fisher;  ///< F = Σ (∂value/∂d)ᵀ (∂value/∂d) / σ²              [k x k]
  double chi_square = 0.0;              ///< Σ (residual / σ)²
  Eigen::Index degrees_of_freedom = 0;  ///< data − k; negative if data are too few
  double sigma_factor = 1.0;            ///< √(χ² / degrees of freedom), if requested; else 1

  /// Directions about which the data say nothing, of length 1 in units of scale. The members below
  /// `message` are sized only if there is none.                                        [k x …]
  Eigen::MatrixXd silent;
  std::string message;  ///< those directions in words; empty if there is none

  Eigen::MatrixXd covariance;  ///< σ_factor² F⁻¹                                [k x k]
  Eigen::VectorXd standard_deviations;  ///< √ of its diagonal                            [k]
  Eigen::MatrixXd correlation;          ///< ones on the diagonal                         [k x k]
  Eigen::VectorXd lower;                ///< of the confidence interval of each           [k]
  Eigen::VectorXd upper;                ///< of the confidence interval of each           [k]

  /// Whether every direction is determined; only then are there covariances and intervals.
  [[nodiscard]] bool complete() const { return silent.cols() == 0; }
};

/// The Fisher information of a fit and what follows from it, from the singular values of the
/// sensitivity in units of scale and σ, with columns scaled to equal length.
///
/// @throws InvalidInput if sizes disagree, a number is not finite, a scale or σ is not positive,
///   the level is outside (0, 1), or σ is to be estimated from no more data than parameters
[[nodiscard]] Information information(const Fit& fit, const InformationOptions& options = {});

/// The z for which a standard normal number lies within ±z with a probability of `level`.
///
/// @throws InvalidInput if level is outside (0, 1)
[[nodiscard]] double normal_quantile(double level);

}  // namespace hbar::study
