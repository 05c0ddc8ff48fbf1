// Gradients of simulations with contact, verified by check_gradient where points touch, leave,
// stick and slide, at rest and at grazing contact.

#include <gtest/gtest.h>

#include <algorithm>

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "hbar/solvers/linear/klu.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::contact_problem;
using testing::ContactChoice;

/// How often a contact of the problem is made and broken; steps at which points stick, slide.
struct Events {
  int makes = 0;
  int breaks = 0;
  int sticking = 0;
  int sliding = 0;
};

Events events_of(const Problem& problem) {
  const auto history =
      contact_history(problem.horizon, simulate(problem.horizon, problem.inputs).trajectory());
  Events events;
  for (std::size_t k = 1; k < history.size(); ++k) {
    for (std::size_t c = 0; c < history[k].size(); ++c) {
      const ContactSummary& now = history[k][c];
      events.makes += now.active > history[k - 1][c].active ? 1 : 0;
      events.breaks += now.active < history[k - 1][c].active ? 1 : 0;
      events.sticking += now.sticking > 0 ? 1 : 0;
      events.sliding += now.sticking < now.active ? 1 : 0;
    }
  }
  return events;
}

/// Every class passes, and nearly every one has room for an order on its own smooth piece: the next
/// point to touch, leave, stick or slide may be so near that differences alone fit in.
void expect_verified(const Problem& problem, const GradientCheckOptions& options) {
  const GradientCheckReport report = check_gradient(problem, options);
  EXPECT_TRUE(report.passed()) << report.table();
  EXPECT_EQ(report.rows.size(), parameter_kinds().size() + 3U) << report.table();
  const auto without_order =
      std::count_if(report.rows.begin(), report.rows.end(),
                    [](const GradientCheckRow& row) { return row.remainder_vanishes; });
  EXPECT_LE(without_order, 3) << report.table();
}

class ContactGradientOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(ContactGradientOfEveryIntegrator, PassesInEveryClassWhilePointsTouchLeaveStickAndSlide) {
  Problem problem = contact_problem(GetParam(), 0.01, 40);
  const Events events = events_of(problem);
  EXPECT_GE(events.makes, 5);
  EXPECT_GE(events.breaks, 2);
  EXPECT_GE(events.sticking, 20);
  EXPECT_GE(events.sliding, 10);
  expect_verified(problem, {.directions = 2});
}

TEST(ContactGradient, PassesOverTwoHundredSteps) {
  Problem problem = contact_problem("bdf1", 0.005, 200);
  expect_verified(problem, {.directions = 1});
}

TEST_P(ContactGradientOfEveryIntegrator, PassesWithSmoothFriction) {
  Problem problem = contact_problem(GetParam(), 0.01, 40, {.friction = FrictionLaw::kSmooth});
  expect_verified(problem, {.directions = 1, .seed = 2});
}

TEST_P(ContactGradientOfEveryIntegrator, PassesWhereTheOtherBodyReactsAtItsSurface) {
  Problem problem = contact_problem(GetParam(), 0.01, 40, {.reaction = Reaction::kSurface});
  expect_verified(problem, {.directions = 1});
}

TEST_P(ContactGradientOfEveryIntegrator, PassesForATactileObjective) {
  Problem problem = contact_problem(GetParam(), 0.01, 40);
  problem.objective = Objective(squared_tactile());
  expect_verified(problem, {.directions = 1});
}

TEST_P(ContactGradientOfEveryIntegrator, IsThatOfTheAssembledAdjoint) {
  for (const Reaction reaction : {Reaction::kPoint, Reaction::kSurface}) {
    Problem problem = contact_problem(GetParam(), 0.01, 40, {.reaction = reaction});
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const Gradient swept = gradient(problem.horizon, trajectory, problem.objective);
    for (const bool klu : {false, true}) {
      const solvers::SolverFactory by_klu = [](const auto& options, const auto&) {
        return solvers::make_klu(options);
      };
      AssembledAdjoint assembled(problem.horizon, klu ? by_klu : nullptr);
      const Gradient ours = assembled.gradient(trajectory, problem.objective);
      EXPECT_LT((ours.p - swept.p).norm(), 1e-10 * swept.p.norm()) << klu;
      EXPECT_LT((ours.u - swept.u).norm(), 1e-10 * swept.u.norm()) << klu;
      EXPECT_LT((ours.q0 - swept.q0).norm(), 1e-10 * swept.q0.norm()) << klu;
      EXPECT_LT((ours.qdot0 - swept.qdot0).norm(), 1e-10 * swept.qdot0.norm()) << klu;
    }
  }
}

/// 5 kg on four corners whose lower side is at z = 0, exactly, where q is zero; 10 steps.
Problem box_on_ground(const std::string& integrator, const Eigen::Vector3d& gravity, double kn,
                      double depth, const Eigen::Vector3d& velocity) {
  ModelBuilder builder("box");
  builder.set_gravity(gravity);
  Body body = solid_body("box", Cuboid{{0.2, 0.2, 0.125}}, 1000.0);
  body.contact_points = surface_points(body.shape, {.cuboid = {2, 2, 2}});
  Joint joint{.name = "free", .kind = Free3dExpJoint{}};
  joint.X_PJ.p = {0.0, 0.0, 0.0625};
  const int box = builder.add_link(-1, joint, body, "box", kMaskAll);
  builder.add_contact({.link = box,
                       .surface = Plane{},
                       .coefficients = {.kn = kn, .kt = 40.0, .mu = 0.3, .damping = 1e4}});
  builder.add_end_effector({.name = "corner", .link = box, .position = {0.1, 0.05, 0.02}});
  Problem problem = testing::make_problem(builder.build(), integrator, 0.005, 10);
  problem.inputs.p = problem.horizon.parameters().nominal();
  problem.inputs.q0.setZero();
  problem.inputs.q0[2] = -depth;
  problem.inputs.qdot0.setZero();
  problem.inputs.qdot0.head<3>() = velocity;
  return problem;
}

TEST_P(ContactGradientOfEveryIntegrator, PassesFromExactRest) {
  const double kn = 5e3;
  const double depth = 5.0 * 9.81 / (4.0 * kn);
  Problem problem =
      box_on_ground(GetParam(), {0.0, 0.0, -9.81}, kn, depth, Eigen::Vector3d::Zero());
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  EXPECT_LT((trajectory.q_at_step(10) - problem.inputs.q0).norm(), 1e-13);
  const GradientCheckReport report = check_gradient(problem);
  EXPECT_TRUE(report.passed()) << report.table();
}

double value_of_inputs(const Problem& problem, const Inputs& inputs) {
  const Trajectory trajectory = simulate(problem.horizon, inputs).trajectory();
  return problem.objective.value(read_values(problem.horizon, trajectory));
}

TEST_P(ContactGradientOfEveryIntegrator, IsFiniteAtGrazingAndThatOfTheTouchingSide) {
  // Without gravity the corners skim the plane at d = 0 in every step; pressed, however little,
  // they would stay in it for 0.1 s.
  for (const Eigen::Vector3d& velocity : {Eigen::Vector3d(0.0, 0.0, 0.0), {0.7, -0.2, 0.0}}) {
    Problem problem = box_on_ground(GetParam(), Eigen::Vector3d::Zero(), 300.0, 0.0, velocity);
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const Gradient g = gradient(problem.horizon, trajectory, problem.objective);
    EXPECT_TRUE(g.p.allFinite());
    EXPECT_TRUE(g.q0.allFinite());
    EXPECT_TRUE(g.qdot0.allFinite());
    EXPECT_LT(std::abs(trajectory.q_at_step(10)[2]), 1e-40);  // d rounds to 0
    // Downwards, into contact; extrapolated once.
    const double value = value_of_inputs(problem, problem.inputs);
    for (const bool rate : {false, true}) {
      const auto difference = [&](double step) {
        Inputs inputs = problem.inputs;
        (rate ? inputs.qdot0 : inputs.q0)[2] -= step;
        return (value - value_of_inputs(problem, inputs)) / step;
      };
      const double expected = 2.0 * difference(1e-6) - difference(2e-6);
      const double ours = (rate ? g.qdot0 : g.q0)[2];
      EXPECT_NEAR(ours, expected, 1e-5 * std::abs(expected) + 1e-8) << rate << velocity.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ContactGradientOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

}  // namespace
}  // namespace hbar
