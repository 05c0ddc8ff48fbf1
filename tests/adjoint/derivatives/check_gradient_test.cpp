#include "hbar/adjoint/derivatives/check_gradient.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;
using testing::spinning_problem;

class CheckOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(CheckOfEveryIntegrator, PassesInEveryClass) {
  Problem problem = small_problem(GetParam());
  const GradientCheckReport report = check_gradient(problem);
  EXPECT_TRUE(report.passed()) << report.table();
  // Nine kinds of parameter, controls, initial position and velocity.
  EXPECT_EQ(report.rows.size(), 13U) << report.table();
}

TEST_P(CheckOfEveryIntegrator, PassesAcrossAChangeOfChart) {
  Problem problem = spinning_problem(GetParam());
  const GradientCheckReport report = check_gradient(problem);
  EXPECT_TRUE(report.passed()) << report.table();
}

TEST_P(CheckOfEveryIntegrator, DetectsAPlantedErrorOfOnePartInTenToTheFive) {
  Problem problem = small_problem(GetParam());
  problem.objective = Objective(user_term(
      "planted",
      [](const TrajectoryValues& values) { return 0.5 * values.q.rightCols<1>().squaredNorm(); },
      [](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.q.rightCols<1>() += (1.0 + 1e-5) * values.q.rightCols<1>();
      }));
  // Enough directions that none of them all is nearly square to a class's gradient.
  const GradientCheckReport report = check_gradient(problem, {.directions = 8});
  EXPECT_TRUE(std::none_of(report.rows.begin(), report.rows.end(), [](const GradientCheckRow& row) {
    return row.passed;
  })) << report.table();
}

TEST(CheckGradient, PrintsATableWithItsVerdicts) {
  Problem problem = small_problem("bdf1");
  const std::string table = check_gradient(problem).table();
  EXPECT_NE(table.find("joint transformation (I)"), std::string::npos) << table;
  EXPECT_NE(table.find("initial velocity"), std::string::npos) << table;
  EXPECT_NE(table.find("ok"), std::string::npos) << table;
}

INSTANTIATE_TEST_SUITE_P(All, CheckOfEveryIntegrator, ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
