// Masses, damping and friction from a noisy recording.

#include <gtest/gtest.h>

#include <random>

#include "examples/identify/estimate.h"
#include "examples/identify/report.h"
#include "hbar/adjoint/study/identification.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"

namespace hbar::identify {
namespace {

constexpr const char* kRig = HBAR_SOURCE_DIR "/examples/scenes/identify.xml";

Rig rig_of(int steps, bool sliding = true) {
  return make_rig({.scene = kRig, .steps = steps, .sliding = sliding});
}

Recording recording_of(const Rig& rig, unsigned seed) {
  std::mt19937_64 random(seed);
  return read_recording(rig, default_sigmas(), recorded_csv(rig, default_sigmas(), random),
                        "recording");
}

TEST(Identify, FindsTheTruthWithinThreeStandardDeviations) {
  const Rig rig = rig_of(200);
  const Recording recording = recording_of(rig, 1);
  const auto program = misfit_program(rig, recording);
  const solvers::IpoptResult result = solvers::solve_with_ipopt(*program, fit_options(recording));
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LT(result.iterations, 30);
  const study::Information known = information_at(*program, recording, result.x);
  ASSERT_TRUE(known.complete()) << known.message;
  const Eigen::VectorXd truth = rig.nominal;
  const Eigen::VectorXd error = known.estimate - truth;
  EXPECT_LT(error.cwiseQuotient(known.standard_deviations).lpNorm<Eigen::Infinity>(), 3.0)
      << estimate_table(known, rig.map->variables(), truth);
  // Known to a few per cent, from a start that is off by 40 to 150 %.
  EXPECT_LT(known.standard_deviations.cwiseQuotient(truth).maxCoeff(), 0.1);
  // χ² is what the noise makes it: 402 data less 5, within four of its standard deviations.
  const auto freedom = static_cast<double>(known.degrees_of_freedom);
  EXPECT_NEAR(known.chi_square, freedom, 4.0 * std::sqrt(2.0 * freedom));
  EXPECT_DOUBLE_EQ(known.chi_square, 2.0 * result.objective);
}

/// Errors of fits to different noise, measured by the covariance that each fit states, are the sum
/// of five squared standard normal numbers each.
TEST(Identify, StatesTheCovarianceThatItsFitsScatterWith) {
  constexpr int kFits = 12;
  const Rig rig = rig_of(100);
  double sum = 0.0;
  for (unsigned seed = 1; seed <= kFits; ++seed) {
    const Recording recording = recording_of(rig, seed);
    const auto program = misfit_program(rig, recording);
    const solvers::IpoptResult result = solvers::solve_with_ipopt(*program, fit_options(recording));
    ASSERT_TRUE(result.converged()) << result.message;
    const study::Information known = information_at(*program, recording, result.x);
    const Eigen::VectorXd error = known.estimate - rig.nominal;
    sum += error.dot(known.fisher * error);
  }
  const double expected = 5.0 * kFits;
  EXPECT_NEAR(sum, expected, 4.0 * std::sqrt(2.0 * expected));
}

TEST(Identify, FitsTheSameByEveryOptimiserAndHessian) {
  const Rig rig = rig_of(100);
  const Recording recording = recording_of(rig, 3);
  const std::vector<Way> ways = every_way(rig, recording);
  const study::Information known =
      information_at(*misfit_program(rig, recording), recording,
                     misfit_program(rig, recording)->variables().start);
  for (const Way& way : ways) {
    EXPECT_TRUE(way.converged) << way.name;
    EXPECT_LT((way.unknowns - ways.front().unknowns)
                  .cwiseQuotient(known.standard_deviations)
                  .lpNorm<Eigen::Infinity>(),
              1e-3)
        << way.name;
  }
  EXPECT_NE(ways_table(ways, known.standard_deviations).find("NLopt"), std::string::npos);
}

TEST(Identify, SaysThatFrictionIsUnknownWhereNothingSlides) {
  const Rig rig = rig_of(40, false);
  const Recording recording = recording_of(rig, 1);
  const auto program = misfit_program(rig, recording);
  const study::Information known = information_at(*program, recording, program->variables().start);
  EXPECT_FALSE(known.complete());
  EXPECT_EQ(known.silent.cols(), 1);
  EXPECT_NE(known.message.find("contact.brake.mu"), std::string::npos) << known.message;
  EXPECT_NE(estimate_table(known, rig.map->variables(), {}).find(known.message), std::string::npos);
}

TEST(Identify, PassesIpoptsDerivativeChecker) {
  const Rig rig = rig_of(20);
  const auto program = misfit_program(rig, recording_of(rig, 1));
  const solvers::IpoptDerivativeTest test =
      solvers::test_derivatives_with_ipopt(*program, solvers::HessianKind::kExact, 1e-4, 1e-6);
  EXPECT_TRUE(test.passed()) << test.text;
}

TEST(Identify, MapsAMassOntoMomentsToo) {
  const Rig rig = rig_of(20);
  const ParameterSet& set = rig.horizon.parameters();
  EXPECT_LT((rig.map->parameters(rig.nominal) - set.nominal()).norm(), 1e-15);
  const Eigen::VectorXd p = rig.map->parameters(2.0 * rig.nominal);
  EXPECT_DOUBLE_EQ(p[set.find("body.rod.inertia.y")],
                   2.0 * set[set.find("body.rod.inertia.y")].nominal);
}

TEST(Identify, TakesTheControlsOfATable) {
  const Rig rig = rig_of(2);
  const std::string table =
      "time,q.rail,control.rail,control.guide\n0,0.001,,\n0.01,,0.25,-0.5\n0.02,0.002,0.5,-0.25\n";
  const Recording recording = read_recording(rig, default_sigmas(), table, "table");
  ASSERT_EQ(recording.data.data.size(), 2);
  EXPECT_EQ(recording.data.data, Eigen::Vector2d(0.001, 0.002));
  EXPECT_EQ(recording.sigma, Eigen::Vector2d(1e-3, 1e-3));
  EXPECT_EQ(recording.u, (Eigen::Matrix2d() << 0.25, 0.5, -0.5, -0.25).finished());
  const auto program = misfit_program(rig, recording);
  const Eigen::VectorXd& x = program->variables().start;
  EXPECT_EQ(program->variables().lower.tail<4>(), program->variables().upper.tail<4>());
  EXPECT_EQ(program->inputs(x).u, recording.u);
  // A table without controls was driven as the rig is.
  EXPECT_EQ(read_recording(rig, default_sigmas(), "time,rail\n0.01,0.1\n", "table").u, rig.u);
}

TEST(Identify, RefusesWhatItCannotUse) {
  const Rig rig = rig_of(2);
  const auto read = [&](const std::string& text) {
    static_cast<void>(read_recording(rig, default_sigmas(), text, "table"));
  };
  EXPECT_THROW(read("time,rate.rail\n0.01,0.1\n"), InvalidInput);     // no σ
  EXPECT_THROW(read("time,rail\n0.013,0.1\n"), InvalidInput);         // no step's time
  EXPECT_THROW(read("time,control.rail\n0.01,0.1\n"), InvalidInput);  // not whole
  EXPECT_THROW(static_cast<void>(make_rig({.scene = HBAR_SOURCE_DIR "/examples/scenes/arm.xml"})),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(make_rig({.scene = kRig, .unknowns = {"body.rod.masss"}})),
               InvalidInput);
  EXPECT_THROW(static_cast<void>(coverage({}, rig.nominal)), InvalidInput);
}

TEST(Identify, CountsTheIntervalsThatHoldTheTruth) {
  study::JobReport report;
  for (const double estimate : {0.9, 1.1, 1.5}) {
    study::JobResult result{.converged = true};
    result.numbers = {estimate, 0.1, 7.0};
    report.results.emplace_back(result);
  }
  report.results.emplace_back(std::nullopt);
  const Coverage found = coverage(report, Eigen::VectorXd::Ones(1));
  EXPECT_EQ(found.fits, 3);
  EXPECT_NEAR(found.covered[0], 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(found.bias[0], 0.5 / 3.0, 1e-15);
  EXPECT_NEAR(found.scatter[0], std::sqrt((0.01 + 0.01 + 0.25 - 0.25 / 3.0) / 2.0), 1e-15);
  EXPECT_NEAR(found.predicted[0], 0.1, 1e-15);
  EXPECT_EQ(found.chi_square, 7.0);
  EXPECT_NE(coverage_table(found, {"mass"}).find("66.7 %"), std::string::npos);
}

}  // namespace
}  // namespace hbar::identify
