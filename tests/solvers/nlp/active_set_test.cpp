#include "hbar/solvers/nlp/active_set.h"

#include <gtest/gtest.h>

#include "tests/support/programs.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kHs071Optimum;

TEST(ActiveSet, NamesTheBoundOfEachVariableAndConstraint) {
  Hs071 program;
  program.variables_.lower[2] = program.variables_.upper[2] = 5.0;
  const ScaledNlp scaled(program, 1e-6, 1.0);
  const ActiveSet active = find_active_set(scaled, Eigen::Vector4d(1.0005, 4.9999, 5.0, 3.0),
                                           Eigen::Vector2d(25.01, 39.0), 1e-3);
  EXPECT_EQ(active.variables, (std::vector{Activity::kLower, Activity::kUpper, Activity::kEqual,
                                           Activity::kInactive}));
  EXPECT_EQ(active.constraints, (std::vector{Activity::kInactive, Activity::kEqual}));
}

TEST(MultiplierEstimate, IsThatOfTheOptimum) {
  Hs071 program;
  program.variables_.scale = Eigen::Vector4d(0.5, 3.0, 2.0, 4.0);
  program.limits_.scale = Eigen::Vector2d(5.0, 20.0);
  ScaledNlp scaled(program, 1e-6, 7.0);
  PrimalDualPoint point;
  point.x = kHs071Optimum;
  const MultiplierEstimate estimate = estimate_multipliers(scaled, scaled.scaled(point).x, 1e-6);
  EXPECT_TRUE(estimate.examined);
  EXPECT_TRUE(estimate.dependences.empty());
  EXPECT_LT(estimate.stationarity, 1e-7);
  const PrimalDualPoint found = scaled.unscaled(estimate.point);
  // Known from the literature to the digits given.
  EXPECT_NEAR(found.constraint_multipliers[0], -0.55229366, 1e-6);
  EXPECT_NEAR(found.constraint_multipliers[1], 0.16146857, 1e-6);
  EXPECT_NEAR(found.lower_multipliers[0], 1.08787121, 1e-6);
  EXPECT_EQ(found.upper_multipliers.norm(), 0.0);
}

TEST(MultiplierEstimate, SaysHowFarAPointIsFromStationary) {
  Hs071 program;
  ScaledNlp scaled(program, 1e-6, 1.0);
  const Eigen::Vector4d x(2.0, 2.0, 3.0, 4.0);
  const MultiplierEstimate estimate = estimate_multipliers(scaled, x, 1e-6);
  EXPECT_GT(estimate.stationarity, 1.0);
  EXPECT_EQ(estimate.stationarity,
            lagrangian_gradient(scaled, estimate.point).lpNorm<Eigen::Infinity>());
}

/// c2 = c0 + 2 c1 of four linear constraints; c3 has no gradient.
class Dependent : public testing::Program {
 public:
  Dependent() : Program(Eigen::Vector3d(0.0, 0.0, 0.0), 4) {
    limits_.lower.setZero();
    limits_.upper.setZero();
  }
  double objective(const Eigen::VectorXd& x) override { return x[2]; }
  void objective_gradient(const Eigen::VectorXd&, Eigen::VectorXd& g) override { g << 0, 0, 1; }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override { c = A() * x; }
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd& values) override {
    values << 1, 2, 0, 0, 1, 1, 1, 4, 2, 0, 0, 0;
  }
  static Eigen::MatrixXd A() {
    return (Eigen::MatrixXd(4, 3) << 1, 2, 0, 0, 1, 1, 1, 4, 2, 0, 0, 0).finished();
  }
};

TEST(MultiplierEstimate, FindsDependentConstraints) {
  Dependent program;
  ScaledNlp scaled(program, 1e-6, 1.0);
  const MultiplierEstimate estimate = estimate_multipliers(scaled, program.variables_.start, 1e-6);
  ASSERT_EQ(estimate.dependences.size(), 2U);
  std::vector<std::size_t> sizes;
  for (const Dependence& dependence : estimate.dependences) {
    sizes.push_back(dependence.others.size());
    EXPECT_EQ(dependence.constraint == 3, dependence.others.empty());
  }
  EXPECT_EQ(sizes[0] + sizes[1], 2U) << "one of c0, c1, c2 is a combination of the two others";
}

TEST(MultiplierEstimate, RefusesAPointThatCannotBeEvaluated) {
  testing::Rosenbrock program;
  ScaledNlp scaled(program, 1e-6, 1.0);
  EXPECT_THROW((void)estimate_multipliers(scaled, Eigen::Vector2d(1e200, 0.0), 1e-6),
               EvaluationError);
}

}  // namespace
}  // namespace hbar::solvers
