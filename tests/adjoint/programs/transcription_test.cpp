#include "hbar/adjoint/programs/transcription.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/core/base/error.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

class OfEveryFormulation : public ::testing::TestWithParam<Formulation> {
 protected:
  const TrajectoryProblem problem = testing::small_transcription("bdf2", 6, true);
  std::unique_ptr<Transcription> nlp =
      transcribe(problem, {.formulation = GetParam(), .segments = 2, .threads = 1});
};

/// Rows begin with the problem's own, term by term, and these are the terms' values.
TEST_P(OfEveryFormulation, BeginsWithTheProblemsOwnRows) {
  const Eigen::VectorXd x = testing::near_start(*nlp, 1e-3, 5);
  const Eigen::VectorXd c = testing::constraints_of(*nlp, x);
  const TrajectoryValues values = nlp->trajectory_values(x);
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : problem.constraints) {
    const ConstraintRows& rows = term->rows();
    Eigen::VectorXd expected(rows.size());
    term->values(values, expected);
    EXPECT_EQ(c.segment(first, rows.size()), expected);
    EXPECT_EQ(nlp->constraint_limits().lower.segment(first, rows.size()), rows.lower);
    EXPECT_EQ(nlp->constraint_limits().upper.segment(first, rows.size()), rows.upper);
    EXPECT_EQ(nlp->constraint_limits().names[static_cast<std::size_t>(first)], rows.names[0]);
    first += rows.size();
  }
  EXPECT_GT(first, 0);
}

TEST_P(OfEveryFormulation, RefusesAPointOfAnotherSize) {
  const Eigen::Index n = nlp->variables().start.size();
  EXPECT_EQ(testing::message_of<InvalidInput>(
                [&] { static_cast<void>(nlp->objective(Eigen::VectorXd::Zero(n + 1))); }),
            concat("transcription: x has ", n + 1, " entries; it must have ", n));
}

INSTANTIATE_TEST_SUITE_P(All, OfEveryFormulation,
                         ::testing::Values(Formulation::kShooting, Formulation::kMultipleShooting,
                                           Formulation::kAllAtOnce));

}  // namespace
}  // namespace hbar
