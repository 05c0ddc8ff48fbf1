// What a simulation measures, and that everything differentiated knows it.
#include "hbar/adjoint/trajectory/value_reader.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::contact_problem;
using testing::Random;

/// Reads every measured row at every step, no two with the same weight.
TermPointer every_measured_row() {
  const auto weight = [](Eigen::Index row, Eigen::Index k) {
    return 1.0 + 0.5 * std::sin(1.0 + 2.0 * static_cast<double>(row) + static_cast<double>(k));
  };
  const auto value = [weight](const TrajectoryValues& values) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < values.measured.cols(); ++k) {
      for (Eigen::Index row = 0; row < values.measured.rows(); ++row) {
        sum += weight(row, k) * std::sin(0.2 * values.measured(row, k));
      }
    }
    return sum;
  };
  const auto add_partials = [weight](const TrajectoryValues& values, TrajectoryPartials& partials) {
    for (Eigen::Index k = 0; k < values.measured.cols(); ++k) {
      for (Eigen::Index row = 0; row < values.measured.rows(); ++row) {
        partials.measured(row, k) += 0.2 * weight(row, k) * std::cos(0.2 * values.measured(row, k));
      }
    }
  };
  return user_term("measured", value, add_partials);
}

/// The contact model, measured in every way.
Problem measured_problem(const std::string& integrator) {
  Problem problem = contact_problem(integrator, 0.01, 30);
  const Model& model = problem.horizon.model();
  const int lower = model.find_link("lower");
  const int box = model.find_link("box");
  SimulationOptions options = problem.horizon.options();
  options.measurements = {
      PointVelocity{"tip speed", lower, {0.1, 0.02, 0.0}},
      Orientation{"tilt", box},
      BodyDistance{"gap", model.find_link("ball"), Eigen::Vector3d::Zero(), 0.1, box},
      BodyDistance{"height", lower, {0.1, 0.0, 0.0}, 0.04, -1, Plane{}},
      ContactForce{"ground", 0},
      ContactForce{"press", 2},
      MotorTorque{"torque", 1},
      MotorPower{"power", 0},
      CentreOfMass{"centre"},
      LinearMomentum{"momentum"}};
  problem.horizon = Horizon(problem.horizon.shared_model(), problem.horizon.parameters(), options);
  problem.objective = Objective(every_measured_row());
  return problem;
}

TEST(ValueReader, ReadsMeasurementsWithTheControlOfTheStepThatEnds) {
  Problem problem = measured_problem("bdf1");
  const Horizon& horizon = problem.horizon;
  const TrajectoryValues values =
      read_values(horizon, simulate(horizon, problem.inputs).trajectory());
  ASSERT_EQ(values.measured.rows(), horizon.measured_count());
  ASSERT_EQ(values.measured.cols(), 31);
  EXPECT_EQ(values.declared_count(), 3 + 3 + 1 + 1 + 4 + 4 + 1 + 1 + 3 + 3);
  EXPECT_EQ(values.v().rows(), horizon.model().variable_count());
  EXPECT_EQ(values.tactile().rows(), horizon.model().tactile_count());
  // Motor 0 is a force without a range: its power is u q̇.
  const int row = horizon.measured_index("power");
  const int c = horizon.model().coordinates_of_link(horizon.model().find_link("upper")).begin;
  EXPECT_DOUBLE_EQ(values.measured(row, 0), values.u(0, 0) * values.qdot(c, 0));
  for (int k = 1; k <= 30; ++k) {
    EXPECT_DOUBLE_EQ(values.measured(row, k), values.u(0, k - 1) * values.qdot(c, k));
  }
  const int x = horizon.measured_index("centre.x");
  EXPECT_EQ(horizon.measured_names()[static_cast<std::size_t>(x)], "centre.x");
  EXPECT_GT(values.measured.row(horizon.measured_index("ground.normal")).maxCoeff(), 1.0);
  EXPECT_GT(values.measured.row(horizon.measured_index("press.normal")).maxCoeff(), 1.0);
}

TEST(ValueReader, FindsRowsByNameAndSuggestsTheNearest) {
  const Problem problem = measured_problem("bdf1");
  EXPECT_EQ(testing::message_of<InvalidInput>(
                [&] { static_cast<void>(problem.horizon.measured_index("centre.w")); }),
            "there is no measured row 'centre.w'; did you mean 'centre.x'?");
  const Problem plain = contact_problem("bdf1", 0.01, 3);
  const Model& model = plain.horizon.model();
  EXPECT_EQ(plain.horizon.measured_count(), model.variable_count() + model.tactile_count());
  SimulationOptions options;
  options.measurements = {PointVelocity{"tip", 9}};
  EXPECT_EQ(testing::message_of<InvalidInput>([&] {
              Horizon(plain.horizon.shared_model(), plain.horizon.parameters(), options);
            }),
            "measurement 'tip': link is 9; it must be 0 … 3");
}

class MeasuredByEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST(ValueReader, LeavesMeasurementsGradientsThatPassInEveryClass) {
  Problem problem = measured_problem("bdf2");
  const GradientCheckReport report = check_gradient(problem, {.directions = 1});
  EXPECT_TRUE(report.passed()) << report.table();
}

TEST_P(MeasuredByEveryIntegrator, HaveTheSweepsGradientFromTheAssembledAdjoint) {
  Problem problem = measured_problem(GetParam());
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const Gradient swept = gradient(problem.horizon, trajectory, problem.objective);
  const Gradient ours = AssembledAdjoint(problem.horizon).gradient(trajectory, problem.objective);
  EXPECT_EQ(ours.value, swept.value);
  EXPECT_LT((ours.p - swept.p).norm(), 1e-10 * swept.p.norm());
  EXPECT_LT((ours.u - swept.u).norm(), 1e-10 * swept.u.norm());
  EXPECT_LT((ours.q0 - swept.q0).norm(), 1e-10 * swept.q0.norm());
  EXPECT_LT((ours.qdot0 - swept.qdot0).norm(), 1e-10 * swept.qdot0.norm());
}

TEST_P(MeasuredByEveryIntegrator, HaveTangentsThatTheAdjointTransposes) {
  Problem problem = measured_problem(GetParam());
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  Random random(4);
  TrajectoryPartials partials(read_values(problem.horizon, trajectory));
  partials.measured = random.matrix(partials.measured.rows(), partials.measured.cols());
  const Gradient g = AdjointSweep(problem.horizon).pull_back(trajectory, partials);
  Directions directions = Directions::zero(problem.horizon, 2);
  directions.p = random.matrix(directions.p.rows(), 2);
  directions.u = random.matrix(directions.u.rows(), 2);
  directions.q0 = random.matrix(directions.q0.rows(), 2);
  directions.qdot0 = random.matrix(directions.qdot0.rows(), 2);
  const Tangents tangents = TangentSweep(problem.horizon).push_forward(trajectory, directions);
  ASSERT_EQ(tangents.measured.rows(), partials.measured.size());
  for (int i = 0; i < 2; ++i) {
    const double backward = g.p.dot(directions.p.col(i)) + g.u.reshaped().dot(directions.u.col(i)) +
                            g.q0.dot(directions.q0.col(i)) + g.qdot0.dot(directions.qdot0.col(i));
    const double forward = directional_derivative(partials, tangents, directions, i);
    EXPECT_LT(std::abs(forward - backward), 1e-12 * norm_product(partials, tangents)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, MeasuredByEveryIntegrator, ::testing::Values("bdf1", "bdf2"));

}  // namespace
}  // namespace hbar
