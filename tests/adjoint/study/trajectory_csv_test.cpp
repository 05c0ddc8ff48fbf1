#include "hbar/adjoint/study/trajectory_csv.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/small_problems.h"

namespace hbar::study {
namespace {

TrajectoryNames arm_names() {
  return {.q = {"hinge", "slider"},
          .qdot = {"rate.hinge", "rate.slider"},
          .measured = {"tip.x", "tip.y", "tip.z", "power"},
          .u = {"control.hinge"}};
}

TrajectoryData read_arm(std::string_view text) {
  return read_trajectory_csv(text, "arm.csv", arm_names(), {.h = 0.1, .steps = 10});
}

std::string arm_refusal(std::string_view text) {
  return testing::message_of<InvalidInput>([&] { (void)read_arm(text); });
}

TEST(TrajectoryCsv, IsReadAsItIsWritten) {
  Problem problem = testing::small_problem("bdf2");
  const Horizon& horizon = problem.horizon;
  const TrajectoryValues values =
      read_values(horizon, simulate(horizon, problem.inputs).trajectory());
  const TrajectoryNames names = trajectory_names(horizon);
  const std::string text = trajectory_csv(names, values);
  const TrajectoryData data = read_trajectory_csv(
      text, "t.csv", names, {.h = values.h, .steps = static_cast<int>(values.u.cols())});
  EXPECT_EQ(data.data.size(), values.q.size() + values.qdot.size() + values.measured.size());
  EXPECT_EQ(data.u, values.u);
  for (std::size_t i = 0; i < data.places.size(); ++i) {
    EXPECT_EQ(data.data[static_cast<Eigen::Index>(i)], value_at(values, data.places[i]));
  }
}

TEST(TrajectoryCsv, NamesSensorReadingsAndMeasurements) {
  SimulationOptions options;
  options.measurements = {CentreOfMass{.name = "centre"}, MotorPower{.name = "power", .motor = 1}};
  const Horizon horizon(testing::contact_model(), ParameterSet(), options);
  const Model& model = horizon.model();
  const TrajectoryNames names = trajectory_names(horizon);
  const auto variables = static_cast<std::size_t>(model.variable_count());
  const auto readings = static_cast<std::size_t>(model.tactile_count());
  EXPECT_EQ(names.measured[3], "tip.x");
  EXPECT_EQ(names.measured[variables + 4], "skin.1.shear1");
  EXPECT_EQ(std::vector<std::string>(
                names.measured.begin() + static_cast<std::ptrdiff_t>(variables + readings),
                names.measured.end()),
            (std::vector<std::string>{"centre.x", "centre.y", "centre.z", "power"}));
}

TEST(TrajectoryCsv, MayMeasureSomeNumbersAtSomeSteps) {
  const TrajectoryData data = read_arm(
      "# by hand\ntime,tip.z,rate.slider,power,control.hinge\n"
      "0.1,1,,3,7\n0.3000000001,,5,,\n1,8,,,9\n");
  ASSERT_EQ(data.data.size(), 4);
  EXPECT_EQ(data.data, Eigen::Vector4d(1, 3, 5, 8));
  EXPECT_EQ(data.places[0], (ValuePlace{ValueField::kMeasured, 1, 2}));
  EXPECT_EQ(data.places[1], (ValuePlace{ValueField::kMeasured, 1, 3}));
  EXPECT_EQ(data.places[2], (ValuePlace{ValueField::kQdot, 3, 1}));
  EXPECT_EQ(data.places[3], (ValuePlace{ValueField::kMeasured, 10, 2}));
  EXPECT_EQ(data.by_column(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0)), Eigen::Vector4d(1, 3, 2, 1));
  // A control acted since the one before.
  Eigen::RowVectorXd u = Eigen::RowVectorXd::Constant(10, 9.0);
  u[0] = 7.0;
  EXPECT_EQ(data.u, u);
  EXPECT_THROW((void)data.by_column(Eigen::Vector3d::Ones()), InvalidInput);
}

TEST(TrajectoryCsv, UnderstandsTheCommandsNames) {
  const TrajectoryData data = read_arm("time,q.slider,qdot.hinge\n0,1,2\n");
  EXPECT_EQ(data.places[0], (ValuePlace{ValueField::kQ, 0, 1}));
  EXPECT_EQ(data.places[1], (ValuePlace{ValueField::kQdot, 0, 0}));
  EXPECT_EQ(data.u.size(), 0);
}

TEST(TrajectoryCsv, SaysWhereItIsWrong) {
  EXPECT_EQ(arm_refusal(""), "arm.csv:1: an empty table; it begins with a heading");
  EXPECT_EQ(arm_refusal("t,hinge\n"), "arm.csv:1:1: the first column is \"t\", not time");
  EXPECT_EQ(arm_refusal("time,hinges\n"),
            "arm.csv:1:6: unknown column \"hinges\"; did you mean 'hinge'?");
  EXPECT_EQ(arm_refusal("time,hinge,q.hinge\n"), "arm.csv:1:12: \"q.hinge\" is there twice");
  EXPECT_EQ(arm_refusal("time,hinge\n0.1,1\n0.2\n"),
            "arm.csv:3:1: a row of 1 cells; the heading has 2");
  EXPECT_EQ(arm_refusal("time,hinge\n0.1,one\n"), "arm.csv:2:5: \"one\" is not a finite number");
  EXPECT_EQ(arm_refusal("time,hinge\n0.1,nan\n"), "arm.csv:2:5: \"nan\" is not a finite number");
  EXPECT_EQ(arm_refusal("time,hinge\n0.15,1\n"),
            "arm.csv:2:1: time 0.15 is no multiple of the step 0.1");
  EXPECT_EQ(arm_refusal("time,hinge\n1.1,1\n"),
            "arm.csv:2:1: time 1.1 is outside the simulation, 0 to 1");
  EXPECT_EQ(arm_refusal("time,hinge\n0.2,1\n0.2,1\n"),
            "arm.csv:3:1: time 0.2 does not come after the row before");
  EXPECT_EQ(arm_refusal("time,control.hinge\n0,1\n"),
            "arm.csv:2:3: a control at time 0, before the first step");
  EXPECT_EQ(arm_refusal("time,hinge,control.hinge\n0.4,1,2\n0.7,1,\n"),
            "arm.csv: \"control.hinge\" has no value from step 4 on; there are 10 steps");
  TrajectoryNames names = arm_names();
  names.u.push_back("control.slider");
  EXPECT_EQ(testing::message_of<InvalidInput>([&] {
              (void)read_trajectory_csv("time,control.hinge\n0.1,1\n", "a", names,
                                        {.h = 0.1, .steps = 1});
            }),
            "a: there is no column \"control.slider\"; controls are given for every motor, or for "
            "none");
}

TEST(TrajectoryCsv, RefusesNamesWithTwoMeanings) {
  TrajectoryNames names = arm_names();
  names.measured = {"hinge"};
  EXPECT_EQ(testing::message_of<InvalidInput>([&] {
              (void)read_trajectory_csv("time,hinge\n", "a", names, {.h = 0.1, .steps = 1});
            }),
            "a:1:6: \"hinge\" names more than one number of this model");
}

}  // namespace
}  // namespace hbar::study
