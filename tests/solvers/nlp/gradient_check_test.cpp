#include "hbar/solvers/nlp/gradient_check.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::message_of;
using testing::Rosenbrock;

const Eigen::Vector4d kPoint(1.3, 4.1, 3.2, 1.7);

TEST(GradientCheck, PassesRightDerivatives) {
  Hs071 program;
  GradientCheck report = check_gradients(program, kPoint);
  EXPECT_LT(report.gap, 1e-8) << report.gap_name;
  EXPECT_NEAR(report.slope, 2.0, 0.1) << report.slope_name;
  program.variables_.scale = Eigen::Vector4d(0.1, 1.0, 10.0, 1.0);
  report = check_gradients(program, kPoint);
  EXPECT_LT(report.gap, 1e-8) << report.gap_name;
}

TEST(GradientCheck, ConvictsAnErrorOfOnePartInAHundredThousand) {
  Hs071 program;
  program.jacobian_factor = 1.0 + 1e-5;
  EXPECT_GT(check_gradients(program, kPoint).gap, 3e-6);
  Rosenbrock other;
  other.gradient_factor = 1.0 + 1e-5;
  EXPECT_GT(check_gradients(other, Eigen::Vector2d(-1.2, 1.0)).gap, 1e-6);
}

TEST(GradientCheck, NamesTheWrongDerivativeAndSeesTheFirstOrder) {
  Hs071 program;
  program.jacobian_factor = 1.1;
  const GradientCheck report = check_gradients(program, kPoint);
  EXPECT_EQ(report.gap_name, "product by x3");
  EXPECT_NEAR(report.slope, 1.0, 0.1);
  EXPECT_EQ(report.slope_name.find("product along direction "), 0U) << report.slope_name;
}

TEST(GradientCheck, LeavesOutStepsThatCannotBeEvaluated) {
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd& x) {
    if (x[0] < -1.2 - 5e-6) {
      throw EvaluationError("stalled");
    }
  };
  EXPECT_LT(check_gradients(program, Eigen::Vector2d(-1.2, 1.0)).gap, 1e-8);
  program.on_objective = [](const Eigen::VectorXd& x) {
    if (x[0] != -1.2) {
      throw EvaluationError("stalled");
    }
  };
  EXPECT_EQ(message_of<EvaluationError>(
                [&] { (void)check_gradients(program, Eigen::Vector2d(-1.2, 1.0)); }),
            "check_gradients: no step along direction 0 can be evaluated");
  EXPECT_EQ(message_of<InvalidInput>([&] { (void)check_gradients(program, kPoint); }),
            "check_gradients: x has 4 entries; expected 2");
}

}  // namespace
}  // namespace hbar::solvers
