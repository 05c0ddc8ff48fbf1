// The manipulation examples: what their programs do, without the printing.

#include <gtest/gtest.h>

#include "examples/manipulation/run_task.h"
#include "examples/manipulation/tasks.h"
#include "hbar/core/base/error.h"

namespace hbar::manipulation {
namespace {

TEST(Manipulation, TurnsTheBoxByAQuarter) {
  const Task task = rotate_box();
  const TaskResult result = solve_task(task, {});
  EXPECT_TRUE(result.last.converged()) << result.last.message;
  EXPECT_LE(result.iterations, 100);
  EXPECT_GT(result.start_errors[0], 0.3) << "the first guess does not reach the goal";
  EXPECT_TRUE(result.reached(task)) << result.errors.transpose();
  EXPECT_LT(result.last.objective, 0.1 * result.start_objective);
}

TEST(Manipulation, FlipsTheBoxOverItsEdge) {
  const Task task = flip_box();
  const TaskResult result = solve_task(task, {});
  EXPECT_TRUE(result.last.converged()) << result.last.message;
  EXPECT_LE(result.iterations, 100);
  EXPECT_GT(result.start_errors[0], 0.3) << "from the first guess the box falls back";
  EXPECT_TRUE(result.reached(task)) << result.errors.transpose();
  // The box lies still on its side: its height is what it was.
  const Eigen::VectorXd last = result.values.q.rightCols<1>();
  EXPECT_NEAR(last[7], 0.0, 1e-3);
  EXPECT_LT(result.values.qdot.rightCols<1>().segment<3>(8).norm(), 0.1);
}

/// The first stage of the continuation, with the softest fingertips.
TEST(Manipulation, BringsTwoBoxesTogetherInPart) {
  Task task = assemble();
  task.contact_scales = {task.contact_scales.front()};
  TaskOptions options;
  options.max_iterations = 30;
  const TaskResult result = solve_task(task, options);
  EXPECT_LE(result.iterations, 30);
  EXPECT_LT(result.last.objective, 0.1 * result.start_objective);
}

/// The gradient that Ipopt gets, where the first guess touches.
TEST(Manipulation, HasTheGradientThatDifferencesGive) {
  for (Task task : {rotate_box(), flip_box(), assemble()}) {
    const auto problem = make_problem(task, 1.0);
    const Eigen::VectorXd x = problem->variables().start;
    Eigen::VectorXd gradient(x.size());
    problem->objective_gradient(x, gradient);
    // Along the gradient in the variables' own sizes; a kink costs a share of the step.
    const Eigen::VectorXd d = gradient.cwiseProduct(problem->variables().scale.cwiseAbs2());
    const double slope = gradient.dot(d);
    const double e = 1e-5 / (d.cwiseQuotient(problem->variables().scale)).norm();
    const double difference =
        (problem->objective(x + e * d) - problem->objective(x - e * d)) / (2.0 * e);
    EXPECT_NEAR(difference / slope, 1.0, 1e-3) << task.name;
  }
}

/// The objective's own second partials, which exact and Gauss-Newton Hessians ask for, say how its
/// partials change from one trajectory to another: it is quadratic.
TEST(Manipulation, HasExactSecondPartials) {
  const Task task = rotate_box();
  const auto problem = make_problem(task, 1.0);
  TrajectoryValues values = problem->trajectory_values(problem->variables().start);
  const Objective& objective = problem->problem().objective;
  const std::vector<SecondPlace> places = objective.second_places(values);
  const Eigen::VectorXd second = objective.second_partials(values);
  double bend = 0.0;  // δᵀ ∂²Ψ δ for the step δ = 1 of every number
  for (std::size_t i = 0; i < places.size(); ++i) {
    bend += (places[i].a == places[i].b ? 1.0 : 2.0) * second[static_cast<Eigen::Index>(i)];
  }
  const double here = objective.value(values);
  const auto move = [&](double step) {
    for (Eigen::MatrixXd* numbers : {&values.q, &values.qdot, &values.u}) {
      numbers->array() += step;
    }
    return objective.value(values);
  };
  const double ahead = move(1.0);
  const double behind = move(-2.0);
  EXPECT_NEAR(ahead - 2.0 * here + behind, bend, 1e-9 * bend);
}

TEST(Manipulation, StretchesItsPhalangesBothWays) {
  const auto problem = make_problem(rotate_box(), 1.0);
  const DesignMap& map = *problem->problem().map;
  const ParameterSet& set = problem->problem().horizon.parameters();
  const Eigen::VectorXd start = map.variables().start;
  EXPECT_EQ(map.parameters(start), set.nominal());
  const Eigen::VectorXd moved = map.parameters(start + Eigen::Vector3d(0.01, 0.02, 0.04));
  EXPECT_NEAR(moved[set.find("body.middle.length")], start[1] + 0.02, 1e-15);
  EXPECT_NEAR(std::abs(moved[set.find("joint.distal_hinge.translation.z")]), 0.02, 1e-15);
}

TEST(Manipulation, RefusesATaskOfAnotherScene) {
  Task task = rotate_box();
  task.goals[0].coordinate = "lid.c";
  EXPECT_THROW(static_cast<void>(make_problem(task, 1.0)), InvalidInput);
  task = rotate_box();
  task.lengths[0].segments[0].body = "box";
  EXPECT_THROW(static_cast<void>(make_problem(task, 1.0)), InvalidInput);
}

}  // namespace
}  // namespace hbar::manipulation
