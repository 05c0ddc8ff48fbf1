#include "hbar/adjoint/derivatives/second_order.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/input_vector.h"
#include "tests/support/message_of.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::flatten;
using testing::Random;
using testing::unflatten;

/// A direction that moves every input, each about as much as its own size allows.
Eigen::VectorXd some_direction(const Inputs& inputs, unsigned seed) {
  Random random(seed);
  const Eigen::VectorXd x = flatten(inputs);
  return random.vector(x.size()).cwiseProduct(x.cwiseAbs().cwiseMin(1.0).cwiseMax(0.02));
}

/// The problem with coefficients off the ends of their ranges, so that both sides can be
/// differenced.
Problem inside(Problem problem) {
  const ParameterSet& set = problem.horizon.parameters();
  for (int k = 0; k < set.size(); ++k) {
    double& value = problem.inputs.p[k];
    if (row_of(set[k].kind).range == ParameterRange::kNonNegative && value == 0.0) {
      value = 0.05;
    }
  }
  return problem;
}

struct NamedProblem {
  std::string name;
  Problem (*make)();
};

const std::vector<NamedProblem>& second_order_problems() {
  static const std::vector<NamedProblem> all = {
      {"Bdf1", [] { return testing::small_problem("bdf1"); }},
      {"Sdirk2", [] { return testing::small_problem("sdirk2"); }},
      {"Bdf2", [] { return testing::small_problem("bdf2"); }},
      {"ChartChange", [] { return testing::spinning_problem("bdf2"); }},
      {"ContactBdf1", [] { return inside(testing::contact_problem("bdf1", 0.002, 40)); }},
      {"ContactBdf2", [] { return inside(testing::contact_problem("bdf2", 0.002, 40)); }}};
  return all;
}

class SecondOrderOf : public ::testing::TestWithParam<NamedProblem> {};

/// Differences of gradients against products, and the remainder of the quadratic model.
TEST_P(SecondOrderOf, ProductsAreDerivativesOfGradients) {
  Problem problem = GetParam().make();
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  HessianProduct hessian(problem.horizon, problem.objective);
  const Gradient gradient = hessian.set_point(trajectory);
  const Eigen::VectorXd x = flatten(problem.inputs);
  const Eigen::VectorXd direction = some_direction(problem.inputs, 7);
  const Gradient product = hessian.along(unflatten(direction, problem.inputs));
  const auto gradient_at = [&](double e) {
    const Inputs moved = unflatten(x + e * direction, problem.inputs);
    const Trajectory there = simulate(problem.horizon, moved).trajectory();
    return flatten(hbar::gradient(problem.horizon, there, problem.objective));
  };
  double gap = 1.0;
  for (const double e : {1e-3, 1e-4, 1e-5}) {
    const Eigen::VectorXd difference = (gradient_at(e) - gradient_at(-e)) / (2.0 * e);
    gap = std::min(gap, testing::relative_gap(flatten(product), difference));
  }
  EXPECT_LT(gap, 1e-7);

  const double slope = flatten(gradient).dot(direction);
  const double curvature = flatten(product).dot(direction);
  EXPECT_NEAR(product.value, 0.5 * curvature, 1e-12 * std::abs(curvature));
  std::vector<double> remainders;
  for (double e = 1e-2; e > 1e-5; e /= 2.0) {
    const double there = testing::objective_of(problem.horizon, problem.objective,
                                               unflatten(x + e * direction, problem.inputs));
    const double remainder = std::abs(there - gradient.value - e * slope - 0.5 * e * e * curvature);
    if (remainder < 1e-12 * std::abs(gradient.value)) {
      break;
    }
    remainders.push_back(remainder);
  }
  ASSERT_GE(remainders.size(), 3U);
  const std::size_t n = remainders.size();
  EXPECT_NEAR(std::log2(remainders[n - 3] / remainders[n - 1]) / 2.0, 3.0, 0.1);
}

TEST_P(SecondOrderOf, TheHessianIsSymmetric) {
  Problem problem = GetParam().make();
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  HessianProduct hessian(problem.horizon, problem.objective);
  static_cast<void>(hessian.set_point(trajectory));
  const Eigen::VectorXd a = some_direction(problem.inputs, 1);
  const Eigen::VectorXd b = some_direction(problem.inputs, 2);
  const Eigen::VectorXd Ha = flatten(hessian.along(unflatten(a, problem.inputs)));
  const Eigen::VectorXd Hb = flatten(hessian.along(unflatten(b, problem.inputs)));
  EXPECT_LT(std::abs(b.dot(Ha) - a.dot(Hb)), 1e-10 * (b.norm() * Ha.norm() + a.norm() * Hb.norm()));
}

INSTANTIATE_TEST_SUITE_P(EveryProblem, SecondOrderOf, ::testing::ValuesIn(second_order_problems()),
                         [](const auto& c) { return c.param.name; });

TEST(SecondOrder, OfConstantWeightsIsCurvatureAlone) {
  Problem problem = testing::small_problem("bdf1");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  TrajectoryPartials weights(read_values(problem.horizon, trajectory));
  weights.u.setConstant(0.7);
  weights.p.setConstant(-0.3);
  SecondOrderSweep sweep(problem.horizon);
  // Inputs themselves are values, and no curvature comes of them.
  const Gradient gradient = sweep.set_point(trajectory, weights);
  EXPECT_TRUE(gradient.u.isConstant(0.7, 0.0));
  static_cast<void>(
      sweep.push_forward(unflatten(some_direction(problem.inputs, 3), problem.inputs)));
  EXPECT_EQ(flatten(sweep.product()).norm(), 0.0);
}

TEST(SecondOrder, TangentsAreThoseOfTheAssembledSystem) {
  Problem problem = testing::small_problem("bdf2");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const Inputs direction = unflatten(some_direction(problem.inputs, 4), problem.inputs);
  SecondOrderSweep sweep(problem.horizon);
  static_cast<void>(
      sweep.set_point(trajectory, TrajectoryPartials(read_values(problem.horizon, trajectory))));
  const ValueTangent& tangent = sweep.push_forward(direction);
  Directions along = Directions::zero(problem.horizon, 1);
  along.p = direction.p;
  along.u = direction.u.reshaped();
  along.q0 = direction.q0;
  along.qdot0 = direction.qdot0;
  const Tangents expected = TangentSweep(problem.horizon).push_forward(trajectory, along);
  EXPECT_LT(testing::relative_gap(Eigen::VectorXd(tangent.q.reshaped()), expected.q.col(0)), 1e-11);
  EXPECT_LT(testing::relative_gap(Eigen::VectorXd(tangent.qdot.reshaped()), expected.qdot.col(0)),
            1e-11);
  EXPECT_LT(
      testing::relative_gap(Eigen::VectorXd(tangent.measured.reshaped()), expected.measured.col(0)),
      1e-11);
}

TEST(SecondOrder, WithoutCurvatureIsExactWhereTheMotionIsTheTarget) {
  Problem problem = testing::small_problem("bdf2");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const TrajectoryValues values = read_values(problem.horizon, trajectory);
  Objective objective(tracking(values.q.rightCols(values.q.cols() - 1)));
  objective.add(variable_tracking(values.v().rightCols(values.v().cols() - 1), 0.3));
  const Inputs direction = unflatten(some_direction(problem.inputs, 5), problem.inputs);
  HessianProduct there(problem.horizon, objective);
  static_cast<void>(there.set_point(trajectory));
  const Eigen::VectorXd exact = flatten(there.along(direction));
  const Eigen::VectorXd gauss_newton =
      flatten(there.along(direction, solvers::HessianKind::kGaussNewton));
  EXPECT_LT(testing::relative_gap(gauss_newton, exact), 1e-9);

  HessianProduct elsewhere(problem.horizon, problem.objective);
  static_cast<void>(elsewhere.set_point(trajectory));
  const Gradient product = elsewhere.along(direction, solvers::HessianKind::kGaussNewton);
  EXPECT_GT(product.value, 0.0);
  EXPECT_GT(testing::relative_gap(flatten(product), flatten(elsewhere.along(direction))), 1e-3);
}

TEST(SecondOrder, EndsWhenAskedAndContinuesAfterwards) {
  std::atomic<bool> stop = false;
  const Problem problem = testing::small_problem("bdf1");
  SimulationOptions options = problem.horizon.options();
  options.stop = &stop;
  const Horizon horizon = problem.horizon.with(options);
  const Trajectory trajectory = simulate(horizon, problem.inputs).trajectory();
  const TrajectoryPartials weights = problem.objective.partials(read_values(horizon, trajectory));
  const Inputs direction = unflatten(some_direction(problem.inputs, 7), problem.inputs);
  const int last = trajectory.timeline.last_stage();
  SecondOrderSweep sweep(horizon);
  const auto message = [&stop](const auto& call) {
    stop = true;
    std::string text = testing::message_of<Interrupted>(call);
    stop = false;
    return text;
  };
  EXPECT_EQ(message([&] { sweep.set_point(trajectory, weights); }),
            concat("backward sweep interrupted at stage ", last, " of ", last));
  sweep.set_point(trajectory, weights);
  EXPECT_EQ(message([&] { sweep.push_forward(direction); }),
            concat("second order: forward sweep interrupted at stage 1 of ", last));
  EXPECT_THROW(static_cast<void>(sweep.product()), InvalidInput) << "there is no direction";
  sweep.push_forward(direction);
  EXPECT_EQ(message([&] { static_cast<void>(sweep.product()); }),
            concat("backward sweep interrupted at stage ", last, " of ", last));
  SecondOrderSweep other(problem.horizon);
  other.set_point(trajectory, weights);
  other.push_forward(direction);
  EXPECT_EQ(flatten(sweep.product()), flatten(other.product()));
}

TEST(SecondOrder, RefusesADirectionOfAnotherShape) {
  Problem problem = testing::small_problem("bdf1");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  HessianProduct hessian(problem.horizon, problem.objective);
  static_cast<void>(hessian.set_point(trajectory));
  Inputs direction = problem.inputs;
  direction.q0.conservativeResize(1);
  EXPECT_THROW(static_cast<void>(hessian.along(direction)), InvalidInput);
  EXPECT_THROW(
      static_cast<void>(hessian.along(problem.inputs, solvers::HessianKind::kLimitedMemory)),
      InvalidInput);
}

}  // namespace
}  // namespace hbar
