#include "hbar/solvers/nlp/diagnosis.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kHs071Optimum;
using testing::message_of;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A result as optimisers give them.
struct FakeResult {
  PrimalDualPoint fake_point;
  std::string message;
  [[nodiscard]] PrimalDualPoint point() const { return fake_point; }
};

TEST(Diagnosis, OfAnOptimumNamesWhatHoldsItAndAdvisesNothing) {
  Hs071 program;
  program.variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
  program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  FakeResult result{{.x = kHs071Optimum}, "solver: optimal"};
  const Diagnosis d = diagnose(program, result);
  EXPECT_TRUE(d.advice.empty()) << d.text();
  ASSERT_EQ(d.constraints.size(), 2U);
  EXPECT_EQ(d.constraints[0].name, "product");
  EXPECT_EQ(d.constraints[0].activity, Activity::kLower);
  EXPECT_EQ(d.constraints[0].bound, 25.0);
  EXPECT_NEAR(d.constraints[0].value, 25.0, 1e-6);
  EXPECT_NEAR(d.constraints[0].multiplier, 0.55229366, 1e-6);
  EXPECT_EQ(d.constraints[1].activity, Activity::kEqual);
  ASSERT_EQ(d.variables.size(), 1U);
  EXPECT_EQ(d.variables[0].name, "x0");
  EXPECT_NEAR(d.variables[0].multiplier, 1.0878712, 1e-6);
  EXPECT_LT(d.stationarity, 1e-5);
  const std::string text = d.text();
  EXPECT_TRUE(contains(text, "solver: optimal\nobjective 17.014")) << text;
  EXPECT_TRUE(contains(text, "2 active constraints:\n  product = 25, lower bound 25, multiplier "))
      << text;
  EXPECT_TRUE(contains(text, "1 variables on a bound:\n  x0 = 1, lower bound 1")) << text;
  EXPECT_FALSE(contains(text, "try: ")) << text;
}

TEST(Diagnosis, TakesTheMultipliersThatFitBetter) {
  Hs071 program;
  PrimalDualPoint point{.x = kHs071Optimum};
  const Diagnosis without = diagnose_point(program, point);
  point.constraint_multipliers = Eigen::Vector2d(5.0, 5.0);
  const Diagnosis wrong = diagnose_point(program, point);
  EXPECT_EQ(wrong.stationarity, without.stationarity);
  // An optimiser's own multipliers count although x is not exactly on its bounds.
  point.x[0] += 1e-3;
  point.constraint_multipliers = Eigen::Vector2d(-0.55229366, 0.16146857);
  point.lower_multipliers = Eigen::Vector4d(1.08787121, 0, 0, 0);
  EXPECT_LT(diagnose_point(program, point).stationarity, 0.02);
}

TEST(Diagnosis, NamesTheWorstViolationAndWhatIsUnbalanced) {
  Hs071 program;
  const Diagnosis d = diagnose_point(program, {.x = Eigen::Vector4d(2.0, 2.5, 2.0, 2.0)});
  EXPECT_EQ(d.violation.name, "sphere");
  EXPECT_EQ(d.violation.amount, 21.75);
  EXPECT_EQ(d.objective, 28.0);
  ASSERT_EQ(d.advice.size(), 2U) << d.text();
  EXPECT_TRUE(contains(d.advice[0], "relax the bounds of sphere"));
  EXPECT_TRUE(contains(d.advice[1], "the gradient by " + d.least_stationary + " is not balanced"));
  EXPECT_TRUE(contains(d.advice[1], "they have no scale"));
  EXPECT_TRUE(contains(d.text(), "worst violation: sphere by 21.75")) << d.text();
}

/// Equations x0 = 0, 2 x0 = 0, and one that nothing moves.
class Redundant : public testing::Program {
 public:
  Redundant() : Program(Eigen::Vector2d::Zero(), 3) {
    limits_.lower.setZero();
    limits_.upper.setZero();
    limits_.names = {"once", "twice", "stuck"};
  }
  double objective(const Eigen::VectorXd& x) override { return x[1] * x[1]; }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    g << 0.0, 2.0 * x[1];
  }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override {
    c << x[0], 2.0 * x[0], 0.0;
  }
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd& values) override {
    values << 1.0, 0.0, 2.0, 0.0, 0.0, 0.0;
  }
};

TEST(Diagnosis, NamesDependentConstraints) {
  Redundant program;
  const Diagnosis d = diagnose_point(program, {.x = Eigen::Vector2d::Zero()});
  ASSERT_EQ(d.dependent.size(), 2U);
  const std::string text = d.text();
  EXPECT_TRUE(contains(text, "once depends on twice\n")) << text;
  EXPECT_TRUE(contains(text, "stuck is moved by no free variable\n")) << text;
  EXPECT_TRUE(contains(text, "try: remove once or a constraint it depends on\n")) << text;
  EXPECT_TRUE(contains(text, "try: no free variable moves stuck here")) << text;
}

TEST(Diagnosis, RefusesAPointThatCannotBeEvaluatedOrDoesNotFit) {
  testing::Rosenbrock program;
  EXPECT_THROW((void)diagnose_point(program, {.x = Eigen::Vector2d(1e200, 0.0)}), EvaluationError);
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { (void)diagnose_point(program, {.x = Eigen::Vector3d(0, 0, 0)}); }),
            "point: x has 3 entries; expected 2");
}

}  // namespace
}  // namespace hbar::solvers
