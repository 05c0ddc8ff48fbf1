#include "hbar/adjoint/study/information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "hbar/core/base/error.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar::study {
namespace {

using hbar::testing::Random;

/// Three parameters of different sizes, measured a dozen times with different accuracy.
Fit small_fit() {
  Random random(11);
  Fit fit;
  fit.names = {"mass", "length", "stiffness"};
  fit.estimate = Eigen::Vector3d(2.0, 0.3, 1e4);
  fit.scale = Eigen::Vector3d(1.0, 0.1, 1e3);
  fit.sensitivity = random.matrix(12, 3) * Eigen::Vector3d(1.0, 30.0, 1e-4).asDiagonal();
  fit.sigma = random.vector(12, 0.2).array() + 0.3;
  fit.residual = random.vector(12, 0.3);
  return fit;
}

/// A standard normal number, the same on every machine.
double normal(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(random.between(1e-12, 1.0)));
  return radius * std::cos(random.between(0.0, 2.0 * std::numbers::pi));
}

TEST(Information, HasTheQuantilesOfTheNormalDistribution) {
  EXPECT_NEAR(normal_quantile(0.5), 0.67448975019608171, 1e-15);
  EXPECT_NEAR(normal_quantile(0.95), 1.9599639845400545, 1e-14);
  EXPECT_NEAR(normal_quantile(0.6826894921370859), 1.0, 1e-14);
  EXPECT_NEAR(normal_quantile(1.0 - 1e-9), 6.1094102, 1e-6);
  for (const double level : {1e-12, 0.1, 0.999}) {
    EXPECT_NEAR(std::erf(normal_quantile(level) / std::numbers::sqrt2), level, 1e-15);
  }
  for (const double level : {0.0, 1.0, testing::kNan}) {
    EXPECT_THROW((void)normal_quantile(level), InvalidInput);
  }
}

TEST(Information, IsTheInverseOfItsCovariance) {
  const Fit fit = small_fit();
  const Information out = information(fit, {.level = 0.95});
  Eigen::Matrix3d fisher = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 12; ++i) {
    fisher +=
        fit.sensitivity.row(i).transpose() * fit.sensitivity.row(i) / (fit.sigma[i] * fit.sigma[i]);
  }
  EXPECT_LT(testing::relative_gap(out.fisher, fisher), 1e-14);
  ASSERT_TRUE(out.complete());
  EXPECT_EQ(out.message, "");
  const Eigen::Matrix3d scale = fit.scale.asDiagonal();
  const Eigen::Matrix3d product =
      scale.inverse() * (out.covariance * out.fisher) * scale;  // of one unit
  EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  for (int i = 0; i < 3; ++i) {
    const double deviation = out.standard_deviations[i];
    EXPECT_NEAR(deviation * deviation / out.covariance(i, i), 1.0, 1e-14);
    EXPECT_NEAR((out.upper[i] - out.estimate[i]) / deviation, 1.9599639845400545, 1e-9);
    EXPECT_NEAR((out.estimate[i] - out.lower[i]) / deviation, 1.9599639845400545, 1e-9);
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(out.correlation(i, j) * deviation * out.standard_deviations[j] /
                      std::sqrt(out.covariance(i, i) * out.covariance(j, j)),
                  out.covariance(i, j) / std::sqrt(out.covariance(i, i) * out.covariance(j, j)),
                  1e-14);
    }
  }
}

TEST(Information, DoesNotDependOnUnits) {
  const Fit fit = small_fit();
  Fit other = fit;
  const Eigen::Vector3d units(1e-9, 1.0, 1e12);
  other.estimate = units.cwiseProduct(fit.estimate);
  other.scale = units.cwiseProduct(fit.scale);
  other.sensitivity = fit.sensitivity * units.cwiseInverse().asDiagonal();
  const Information a = information(fit);
  const Information b = information(other);
  ASSERT_TRUE(a.complete());
  ASSERT_TRUE(b.complete());
  EXPECT_LT(testing::relative_gap(b.correlation, a.correlation), 1e-12);
  EXPECT_LT(testing::relative_gap(
                (b.standard_deviations.cwiseQuotient(units)).cwiseQuotient(a.standard_deviations),
                Eigen::Vector3d::Ones()),
            1e-12);
}

TEST(Information, NamesWhatTheDataSayNothingOf) {
  Fit fit = small_fit();
  fit.sensitivity.col(1).setZero();
  Information out = information(fit);
  ASSERT_EQ(out.silent.cols(), 1);
  EXPECT_NEAR(std::abs(out.silent(1, 0)), 1.0, 1e-7);
  EXPECT_EQ(out.message,
            "the data say nothing of length (in units of scale): measure what answers to it, or "
            "hold one of these parameters");
  EXPECT_EQ(out.covariance.size(), 0);
  EXPECT_EQ(out.standard_deviations.size(), 0);

  fit = small_fit();  // 0.6 scales of mass answer as 0.8 scales of stiffness do
  fit.sensitivity.col(0) = fit.sensitivity.col(2) * 1e3 * (0.8 / 0.6);
  out = information(fit);
  ASSERT_EQ(out.silent.cols(), 1);
  EXPECT_EQ(out.message.substr(0, 55), "the data say nothing of -0.6 mass + 0.8 stiffness (in u");
  const Eigen::VectorXd silent = fit.scale.asDiagonal() * out.silent.col(0);
  EXPECT_LT((fit.sensitivity * silent).norm(), 1e-12 * fit.sensitivity.col(0).norm());
}

TEST(Information, OfTooFewOrNoDataIsIncomplete) {
  Fit fit = small_fit();
  fit.sensitivity = fit.sensitivity.topRows(2).eval();
  fit.sigma = fit.sigma.head(2).eval();
  fit.residual = fit.residual.head(2).eval();
  const Information two = information(fit);
  EXPECT_EQ(two.silent.cols(), 1);
  EXPECT_TRUE(two.silent.allFinite());
  EXPECT_EQ(two.degrees_of_freedom, -1);

  fit.sensitivity.resize(0, 3);
  fit.sigma.resize(0);
  fit.residual.resize(0);
  const Information none = information(fit);
  EXPECT_EQ(none.silent.cols(), 3);
  EXPECT_TRUE(none.silent.allFinite());
  EXPECT_TRUE(none.fisher.isZero());
}

TEST(Information, EstimatesACommonFactorOfSigma) {
  Fit fit = small_fit();
  const Information known = information(fit);
  const Information estimated = information(fit, {.scale_by_residual = true});
  EXPECT_EQ(known.sigma_factor, 1.0);
  EXPECT_NEAR(estimated.sigma_factor, std::sqrt(known.chi_square / 9.0), 1e-14);
  fit.sigma *= 7.0;
  const Information wrong = information(fit, {.scale_by_residual = true});
  EXPECT_LT(testing::relative_gap(wrong.covariance, estimated.covariance), 1e-13);
}

TEST(Information, ForeseesHowEstimatesScatter) {
  constexpr int kFits = 400;
  const Fit fit = small_fit();
  const Information foreseen = information(fit, {.level = 0.9});
  const Eigen::MatrixXd weighted = fit.sigma.cwiseInverse().asDiagonal() * fit.sensitivity;
  const Eigen::HouseholderQR<Eigen::MatrixXd> least_squares(weighted);
  Random random(5);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double chi_square = 0.0;
  int inside = 0;
  for (int sample = 0; sample < kFits; ++sample) {
    Eigen::VectorXd noise(12);
    for (double& entry : noise) {
      entry = normal(random);
    }
    const Eigen::Vector3d error = least_squares.solve(noise);
    const Eigen::Vector3d relative = error.cwiseQuotient(foreseen.standard_deviations);
    scatter += relative * relative.transpose() / kFits;
    chi_square += (noise - weighted * error).squaredNorm() / kFits;
    inside += std::abs(error[0]) < foreseen.upper[0] - foreseen.estimate[0] ? 1 : 0;
  }
  // Four standard deviations of each: √(2/n) of a variance, √(18/n) of χ² with 9 degrees.
  EXPECT_LT(testing::largest(scatter - foreseen.correlation), 4.0 * std::sqrt(2.0 / kFits));
  EXPECT_NEAR(chi_square, 9.0, 4.0 * std::sqrt(18.0 / kFits));
  EXPECT_NEAR(inside, 0.9 * kFits, 4.0 * std::sqrt(0.9 * 0.1 * kFits));
}

TEST(Information, RefusesWhatMakesNoSense) {
  const auto refused = [](const auto& change, const InformationOptions& options = {}) {
    Fit fit = small_fit();
    change(fit);
    EXPECT_THROW((void)information(fit, options), InvalidInput);
  };
  refused([](Fit& fit) { fit.sigma[3] = 0.0; });
  refused([](Fit& fit) { fit.scale[1] = -1.0; });
  refused([](Fit& fit) { fit.residual[0] = testing::kNan; });
  refused([](Fit& fit) { fit.sensitivity(0, 0) = testing::kInfinity; });
  refused([](Fit& fit) { fit.estimate.conservativeResize(2); });
  refused([](Fit&) {}, {.level = 1.0});
  refused(
      [](Fit& fit) {
        fit.sensitivity = fit.sensitivity.topRows(3).eval();
        fit.sigma = fit.sigma.head(3).eval();
        fit.residual = fit.residual.head(3).eval();
      },
      {.scale_by_residual = true});
}

}  // namespace
}  // namespace hbar::study
