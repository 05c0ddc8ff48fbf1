#include "hbar/solvers/nlp/ipopt_derivatives.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::message_of;
using testing::Rosenbrock;

class IpoptDerivatives : public ::testing::Test {
 protected:
  IpoptDerivatives() { program_.variables_.start << 1.3, 4.1, 3.2, 1.7; }
  Hs071 program_;
};

TEST_F(IpoptDerivatives, PassARightProgramAndPrintNothing) {
  ::testing::internal::CaptureStdout();
  for (const HessianKind second : {HessianKind::kLimitedMemory, HessianKind::kExact}) {
    const IpoptDerivativeTest report = test_derivatives_with_ipopt(program_, second);
    EXPECT_TRUE(report.passed()) << report.text;
    EXPECT_NE(report.text.find("No errors detected"), std::string::npos) << report.text;
  }
  program_.variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
  program_.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  const IpoptDerivativeTest report = test_derivatives_with_ipopt(program_, HessianKind::kExact);
  EXPECT_EQ(report.errors, 0) << report.text;
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST_F(IpoptDerivatives, ConvictAWrongEntryOfTheJacobian) {
  program_.jacobian_factor = 1.01;
  const IpoptDerivativeTest report = test_derivatives_with_ipopt(program_);
  EXPECT_EQ(report.errors, 1) << report.text;
  EXPECT_NE(report.text.find("jac_g [    0,    3]"), std::string::npos) << report.text;
}

TEST_F(IpoptDerivatives, ConvictAWrongHessianWhereItIsAsked) {
  program_.hessian_factor = 1.01;
  EXPECT_TRUE(test_derivatives_with_ipopt(program_).passed());
  EXPECT_GT(test_derivatives_with_ipopt(program_, HessianKind::kExact).errors, 0);
}

TEST_F(IpoptDerivatives, ConvictAWrongEntryOfTheGradient) {
  Rosenbrock program;
  program.gradient_factor = 1.01;
  const IpoptDerivativeTest report = test_derivatives_with_ipopt(program);
  EXPECT_EQ(report.errors, 1) << report.text;
  EXPECT_NE(report.text.find("grad_f"), std::string::npos) << report.text;
}

TEST_F(IpoptDerivatives, RefuseWhatTheyCannotTest) {
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)test_derivatives_with_ipopt(program_, HessianKind::kGaussNewton); }),
            "test_derivatives_with_ipopt: a Gauss-Newton matrix is no derivative; expected kExact "
            "or kLimitedMemory");
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd&) { throw EvaluationError("no step fits"); };
  EXPECT_NE(message_of<EvaluationError>([&] {
              (void)test_derivatives_with_ipopt(program);
            }).find("no step fits"),
            std::string::npos);
}

}  // namespace
}  // namespace hbar::solvers
