#include "hbar/solvers/nlp/hessian_check.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::message_of;
using testing::Rosenbrock;

const Eigen::Vector4d kCurvedPoint(1.3, 4.1, 3.2, 1.7);

TEST(HessianCheck, PassesRightHessiansWhateverTheScale) {
  Hs071 program;
  HessianCheck report = check_hessian(program, kCurvedPoint);
  EXPECT_LT(report.gap, 1e-8) << report.gap_name;
  EXPECT_NEAR(report.slope, 3.0, 0.1) << report.slope_name;
  program.variables_.scale = Eigen::Vector4d(0.1, 1.0, 10.0, 1.0);
  program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  report = check_hessian(program, kCurvedPoint);
  EXPECT_LT(report.gap, 1e-8) << report.gap_name;
  Rosenbrock other;
  report = check_hessian(other, Eigen::Vector2d(-1.2, 1.0));
  EXPECT_LT(report.gap, 1e-8) << report.gap_name;
  EXPECT_NEAR(report.slope, 3.0, 0.1) << report.slope_name;
}

TEST(HessianCheck, ConvictsAnErrorOfOnePartInAHundredThousand) {
  Hs071 program;
  program.hessian_factor = 1.0 + 1e-5;
  EXPECT_GT(check_hessian(program, kCurvedPoint).gap, 1e-6);
  Rosenbrock other;
  other.hessian_factor = 1.0 + 1e-5;
  EXPECT_GT(check_hessian(other, Eigen::Vector2d(-1.2, 1.0)).gap, 1e-6);
}

TEST(HessianCheck, NamesTheWrongEntryAndSeesTheSecondOrder) {
  Rosenbrock program;
  program.hessian_factor = 3.0;
  const HessianCheck report = check_hessian(program, Eigen::Vector2d(-0.2, 0.3));
  EXPECT_GT(report.gap, 0.05);
  EXPECT_EQ(report.gap_name.find("x1 "), 0U) << report.gap_name;
  EXPECT_NEAR(report.slope, 2.0, 0.1);
  EXPECT_EQ(report.slope_name.find("direction "), 0U) << report.slope_name;
}

TEST(HessianCheck, RefusesWhatItCannotCheck) {
  Rosenbrock program;
  EXPECT_EQ(message_of<InvalidInput>([&] { (void)check_hessian(program, kCurvedPoint); }),
            "check_hessian: x has 4 entries; expected 2");
  EXPECT_EQ(message_of<EvaluationError>(
                [&] { (void)check_hessian(program, Eigen::Vector2d(1e200, 0.0)); }),
            "check_hessian: a value or derivative at x is not finite");
}

}  // namespace
}  // namespace hbar::solvers
