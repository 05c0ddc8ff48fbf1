#include "hbar/adjoint/programs/transcribe.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/gradient_check.h"
#include "hbar/solvers/nlp/hessian_check.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

struct Transcribed {
  std::string name;
  TrajectoryProblem (*make)();
  TranscriptionOptions options;
};

/// Every formulation with every integrator, free and given initial states, contact.
std::vector<Transcribed> every_transcription() {
  struct Subject {
    std::string name;
    TrajectoryProblem (*make)();
  };
  const std::vector<Subject> subjects = {
      {"Bdf1", [] { return testing::small_transcription("bdf1", 8, false); }},
      {"Sdirk2Free", [] { return testing::small_transcription("sdirk2", 6, true); }},
      {"Bdf2Free", [] { return testing::small_transcription("bdf2", 8, true); }},
      {"ContactBdf2", [] { return testing::contact_transcription("bdf2", false); }}};
  std::vector<Transcribed> out;
  for (const Subject& subject : subjects) {
    out.push_back({subject.name + "Shooting", subject.make, {}});
    out.push_back({subject.name + "MultipleShooting",
                   subject.make,
                   {.formulation = Formulation::kMultipleShooting, .segments = 3, .threads = 2}});
    out.push_back(
        {subject.name + "AllAtOnce", subject.make, {.formulation = Formulation::kAllAtOnce}});
  }
  return out;
}

/// A point near the start that is no motion and no optimum.
Eigen::VectorXd moved_start(const solvers::Nlp& nlp, double by) {
  Eigen::VectorXd x = nlp.variables().start;
  testing::Random random(11);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] += by * std::min(nlp.variables().scale[i], 1.0) * random.between(-1.0, 1.0);
  }
  return x;
}

class EveryTranscription : public ::testing::TestWithParam<Transcribed> {};

TEST_P(EveryTranscription, HasExactFirstAndSecondDerivatives) {
  const std::unique_ptr<Transcription> nlp = transcribe(GetParam().make(), GetParam().options);
  solvers::validate(*nlp);
  const Eigen::VectorXd x = moved_start(*nlp, 1e-4);
  solvers::GradientCheckOptions options;
  options.directions = 2;
  options.coordinates = false;
  const solvers::GradientCheck first = solvers::check_gradients(*nlp, x, options);
  EXPECT_LT(first.gap, 1e-6) << first.gap_name;
  // Under contact the smooth piece is so short that some rows' remainders are rounding alone; the
  // Lagrangian's below, of all rows together, is not.
  if (nlp->problem().horizon.model().contact_count() == 0) {
    EXPECT_GT(first.slope, 1.9) << first.slope_name;
  }
  const solvers::HessianCheck second = solvers::check_hessian(*nlp, x, options);
  EXPECT_LT(second.gap, 1e-6) << second.gap_name;
  EXPECT_GT(second.slope, 2.9) << second.slope_name;
}

INSTANTIATE_TEST_SUITE_P(All, EveryTranscription, ::testing::ValuesIn(every_transcription()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace hbar
