#include "hbar/adjoint/derivatives/check_gradient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "tests/support/message_of.h"
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

TEST(CheckGradient, ProbesCoefficientsThatAreZeroInsideTheirBounds) {
  ModelBuilder builder("box");
  builder.set_gravity({0.0, 0.0, -9.81});
  Body cube = solid_body("box", Cuboid{{0.2, 0.2, 0.2}}, 1000.0);
  cube.contact_points = surface_points(cube.shape, {.cuboid = {2, 2, 2}});
  const int box = builder.add_link(
      -1, {.name = "base", .kind = Free3dExpJoint{}, .X_PJ = {.p = {0.0, 0.0, 0.099}}}, cube);
  // Only k_n is not 0: neither friction, nor damping of the contact or of the joint.
  Contact contact{.name = "ground", .link = box, .surface = Plane{}};
  contact.coefficients = {.kn = 1000.0, .kt = 0.0, .mu = 0.0, .damping = 0.0};
  builder.add_contact(contact);
  const Model model = builder.build();
  const Horizon horizon(model, ParameterSet::all(model),
                        {.integrator = "bdf2", .h = 0.01, .steps = 5});
  const GradientCheckReport report =
      check_gradient({horizon, Objective(squared_final_position()), horizon.nominal_inputs()});
  EXPECT_TRUE(report.passed()) << report.table();
  EXPECT_TRUE(report.unresolved().empty()) << report.table();
}

/// A ball that bounces on the ground while it rolls on, in units of `length` and `time`.
Problem bounce(double length, double time) {
  ModelBuilder builder("bounce");
  builder.set_gravity({0.0, 0.0, -9.81 * length / (time * time)});
  const double force = length / (time * time);
  const int ball = builder.add_link(
      -1, {.name = "ball", .kind = Free3dExpJoint{}, .X_PJ = {.p = {0.0, 0.0, 0.3 * length}}},
      solid_body("ball", Sphere{0.1 * length}, 240.0 / (length * length * length)));
  Contact contact{.name = "ground", .link = ball, .surface = Plane{}};
  contact.coefficients = {.kn = 2e3 * force / length,
                          .kt = 20.0 * force / length * time,
                          .mu = 0.4,
                          .damping = 200.0 * force / length / length * time};
  builder.add_contact(contact);
  const Model model = builder.build();
  const Horizon horizon(model, {}, {.integrator = "bdf2", .h = 0.002 * time, .steps = 150});
  Inputs inputs = horizon.nominal_inputs();
  inputs.qdot0 << 0.1 * length, 0.2 * length, 0.0, 0.0, 0.0, 3.0;
  inputs.qdot0 /= time;
  return {horizon, Objective(squared_final_position()), inputs};
}

TEST(CheckGradient, DoesNotDependOnTheUnits) {
  for (const double length : {1.0, 1e-6, 1e4}) {
    for (const double time : {1.0, 1e-3}) {
      const GradientCheckReport report = check_gradient(bounce(length, time));
      EXPECT_TRUE(report.passed()) << "length " << length << " time " << time << '\n'
                                   << report.table();
    }
  }
}

/// Two balls on a rail that touch exactly at the end of a step.
TEST(CheckGradient, TakesTheSideOnWhichTheObjectiveIsSmooth) {
  ModelBuilder builder("balls");
  const Joint rail{.name = "a", .kind = PrismaticJoint{{1.0, 0.0, 0.0}}};
  const int a = builder.add_link(-1, rail, solid_body("a", Sphere{0.1}, 238.732414637843));
  Joint other = rail;
  other.name = "b";
  const int b = builder.add_link(-1, other, solid_body("b", Sphere{0.1}, 238.732414637843));
  Contact contact{.name = "balls", .link = a, .other = b};
  contact.coefficients = {.kn = 4e5};
  builder.add_contact(contact);
  const Horizon horizon(builder.build(), {}, {.integrator = "sdirk2", .h = 0.001, .steps = 100});
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.31, 0.52;
  inputs.qdot0 << 1.0, 0.0;
  const GradientCheckReport report =
      check_gradient({horizon, Objective(squared_final_position()), inputs});
  EXPECT_TRUE(report.passed()) << report.table();
}

TEST(CheckGradient, EndsWhenAskedWhereverItIs) {
  std::atomic<bool> stop = false;
  Problem problem = small_problem("bdf1");
  SimulationOptions options = problem.horizon.options();
  options.stop = &stop;
  problem.horizon = problem.horizon.with(options);
  int values_read = 0;
  int last_value = 1;
  problem.objective = Objective(user_term(
      "watched",
      [&](const TrajectoryValues& values) {
        stop = ++values_read == last_value;
        return 0.5 * values.q.squaredNorm();
      },
      [](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.q += values.q;
      }));
  const auto message = [&](int last) {
    values_read = 0;
    last_value = last;
    stop = last == 0;
    return testing::message_of<Interrupted>([&] { static_cast<void>(check_gradient(problem)); });
  };
  const int steps = problem.horizon.steps();
  EXPECT_EQ(message(0), concat("simulation interrupted after 0 of ", steps, " steps"));
  EXPECT_EQ(message(1), concat("backward sweep interrupted at stage ", steps, " of ", steps));
  EXPECT_EQ(message(2), "gradient check interrupted");
  EXPECT_EQ(message(50), "gradient check interrupted");
  EXPECT_EQ(message(-1), "") << "never set";
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
