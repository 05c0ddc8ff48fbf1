// Contact against what mechanics says of a body on a plane, for every integrator: depth at rest,
// sliding and its end, rolling, inclined planes, bounces.

#include <gtest/gtest.h>

#include <numbers>

#include "tests/system/contact_scenes.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::body_on_ground;
using testing::ContactProbe;
using testing::ContactRun;

const Vector3d kDown{0.0, 0.0, -9.81};
const Cuboid kBox{{0.2, 0.2, 0.1}};  // 4 kg, four corners at the bottom
constexpr double kBoxMass = 4.0;
constexpr double kBoxHeight = 0.1;

/// A state of one free body: place, velocity, no rotation.
VectorXd six(const Vector3d& linear, const Vector3d& angular = Vector3d::Zero()) {
  VectorXd out(6);
  out << linear, angular;
  return out;
}

class ContactOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(ContactOfEveryIntegrator, LetsABoxRestAtTheDepthThatCarriesIt) {
  const ContactCoefficients k{.kn = 5e3, .kt = 20.0, .mu = 0.5, .damping = 8e4};
  const Model model = body_on_ground(kBox, k, kDown);
  const ParameterSet set = ParameterSet::named(model, {"body.body.contact_scale"});
  for (const double s : {1.0, 2.5}) {
    Horizon horizon = testing::contact_horizon(model, GetParam(), 0.01, 300, set);
    Inputs inputs = horizon.nominal_inputs();
    inputs.p[0] = s;
    inputs.q0[2] = 0.5 * kBoxHeight + 0.004;  // falls
    const Trajectory trajectory = simulate(horizon, inputs).trajectory();
    const auto history = contact_history(horizon, trajectory);
    const double depth = kBoxMass * 9.81 / (k.kn * s * 4.0);
    EXPECT_EQ(history.front()[0].active, 0);
    EXPECT_EQ(history.back()[0].active, 4);
    EXPECT_NEAR(history.back()[0].penetration, depth, 1e-9 * depth) << s;
    EXPECT_NEAR(trajectory.q_at_step(300)[2], 0.5 * kBoxHeight - depth, 1e-9 * depth) << s;
    EXPECT_NEAR(history.back()[0].normal_force, kBoxMass * 9.81, 1e-8) << s;
  }
}

/// z of the box at rest under gravity g.
double resting_height(const ContactCoefficients& k, double g) {
  return 0.5 * kBoxHeight - kBoxMass * g / (4.0 * k.kn);
}

TEST_P(ContactOfEveryIntegrator, StopsASlidingBoxAfterVSquaredOverTwoMuG) {
  // Holding is viscous: k_t must be large for a box that has stopped to stand.
  const ContactCoefficients k{.kn = 2e4, .kt = 1e4, .mu = 0.3, .damping = 4e5};
  const Model model = body_on_ground(kBox, k, kDown);
  const double v = 1.2;
  const ContactRun run(model, GetParam(), 1e-3, 600, six({0.0, 0.0, resting_height(k, 9.81)}),
                       six({v, 0.0, 0.0}));
  const double distance = v * v / (2.0 * k.mu * 9.81);
  EXPECT_NEAR(run.q_end()[0], distance, 0.01 * distance);
  EXPECT_LT(run.qdot_end().norm(), 1e-6);
  EXPECT_LT(std::abs(run.q_end()[1]), 1e-9);
}

TEST_P(ContactOfEveryIntegrator, TurnsASlidingBallIntoARollingOneAtFiveSeventhsOfItsSpeed) {
  const double radius = 0.1;
  const ContactCoefficients k{.kn = 2e4, .kt = 300.0, .mu = 0.2};
  const Model model = body_on_ground(Sphere{radius}, k, kDown);
  const double depth = model.link(0).body.mass * 9.81 / k.kn;
  const double v = 0.8;
  const ContactRun run(model, GetParam(), 2e-3, 200, six({0.0, 0.0, radius - depth}),
                       six({v, 0.0, 0.0}));
  // The impulse of friction changes m v and I ω alike in every step: no truncation error.
  EXPECT_NEAR(run.qdot_end()[0], 5.0 / 7.0 * v, 1e-9);
  EXPECT_NEAR(run.qdot_end()[4], 5.0 / 7.0 * v / radius, 1e-8);
  EXPECT_NEAR(run.q_end()[2], radius - depth, 1e-9);
}

/// The box on a plane that is inclined by `angle`: gravity turns instead.
ContactRun inclined(const std::string& integrator, const ContactCoefficients& k, double angle,
                    int steps) {
  const Vector3d gravity = 9.81 * Vector3d(std::sin(angle), 0.0, -std::cos(angle));
  const Model model = body_on_ground(kBox, k, gravity);
  return {model,
          integrator,
          2e-3,
          steps,
          six({0.0, 0.0, resting_height(k, 9.81 * std::cos(angle))}),
          VectorXd::Zero(6)};
}

TEST_P(ContactOfEveryIntegrator, HoldsABoxOnAPlaneInclinedLessThanAtanMu) {
  ContactCoefficients k{.kn = 2e4, .kt = 2e3, .mu = 0.5, .damping = 4e5};
  for (const double ratio : {0.3, 0.7, 0.95}) {
    const double angle = ratio * std::atan(k.mu);
    const ContactRun run = inclined(GetParam(), k, angle, 500);
    const double speed = run.qdot_end()[0];
    EXPECT_NEAR(run.trajectory.qdot_at_step(400)[0], speed, 1e-6 * speed) << ratio;
    // Holding is viscous: four corners let the box creep at m g sin / (4 k_t). Near the limit the
    // upper two, which carry less, slide, and the lower two hold.
    const double creep = kBoxMass * 9.81 * std::sin(angle) / (4.0 * k.kt);
    EXPECT_NEAR(speed, creep, (ratio < 0.8 ? 1e-6 : 0.5) * creep) << ratio;
  }
}

TEST_P(ContactOfEveryIntegrator, LetsABoxSlideDownASteeperPlaneWithGSinLessMuGCos) {
  const ContactCoefficients k{.kn = 2e4, .kt = 2e3, .mu = 0.3, .damping = 4e5};
  const double angle = 1.5 * std::atan(k.mu);
  const ContactRun run = inclined(GetParam(), k, angle, 500);
  const double expected = 9.81 * (std::sin(angle) - k.mu * std::cos(angle));
  // The second half: by then the box has tilted as far as friction tilts it.
  const double gained = run.trajectory.qdot_at_step(500)[0] - run.trajectory.qdot_at_step(250)[0];
  EXPECT_NEAR(gained / 0.5, expected, 1e-5 * expected);
}

/// A box that falls on an edge, tumbles and slides.
ContactRun tumble(const Model& model, const std::string& integrator, double h, int steps) {
  return {model,
          integrator,
          h,
          steps,
          six({0.0, 0.0, 0.25}, {0.3, -0.5, 0.2}),
          six({1.0, 0.4, -0.5}, {2.0, 1.0, -3.0})};
}

TEST_P(ContactOfEveryIntegrator, NeverLeavesTheFrictionCone) {
  const ContactCoefficients k{.kn = 5e3, .kt = 100.0, .mu = 0.4, .damping = 5e3};
  const Model model = body_on_ground(kBox, k, kDown);
  const ContactRun run = tumble(model, GetParam(), 2e-3, 400);
  ContactProbe probe(model);
  int sliding = 0;
  int sticking = 0;
  for (int stage = 0; stage < run.trajectory.timeline.stage_count(); ++stage) {
    const auto& forces = probe.at(run.trajectory.q.col(stage), run.trajectory.qdot.col(stage));
    for (const auto& pair : forces.active()) {
      for (const auto& point : forces.points(pair)) {
        const double normal = point.force.f.dot(point.n);
        const double friction = (point.force.f - normal * point.n).norm();
        EXPECT_GE(normal, 0.0);
        EXPECT_LE(friction, k.mu * normal * (1.0 + 1e-12) + 1e-14) << stage;
        ++(point.force.sticks ? sticking : sliding);
      }
    }
  }
  EXPECT_GT(sliding, 50);
  EXPECT_GT(sticking, 50);
}

TEST_P(ContactOfEveryIntegrator, LosesEnergyInABounceAndNeverGainsAny) {
  const ContactCoefficients k{.kn = 2e4, .kt = 100.0, .mu = 0.3, .damping = 2e5};
  const Model model = body_on_ground(Sphere{0.1}, k, kDown);
  const ContactRun run(model, GetParam(), 5e-4, 2000, six({0.0, 0.0, 0.25}),
                       six({0.5, 0.2, 0.0}, {0.0, 3.0, -2.0}));
  ContactProbe probe(model);
  probe.at(run.trajectory.q_at_step(0), run.trajectory.qdot_at_step(0));
  const double start = probe.energy();
  double lowest = start;
  double growth = 0.0;
  for (int step = 1; step <= 2000; ++step) {
    probe.at(run.trajectory.q_at_step(step), run.trajectory.qdot_at_step(step));
    growth = std::max(growth, probe.energy() - lowest);
    lowest = std::min(lowest, probe.energy());
  }
  // A method of second order may sway by its truncation error, implicit Euler may not.
  EXPECT_LT(growth, (GetParam() == "bdf1" ? 1e-12 : 1e-4) * start);
  EXPECT_LT(lowest, 0.8 * start);
}

TEST_P(ContactOfEveryIntegrator, ConvergesWithItsOrderAwayFromEvents) {
  // Four corners press and slide all the time; friction tilts the box a little.
  const ContactCoefficients k{.kn = 2e3, .kt = 1e4, .mu = 0.2, .damping = 2e3};
  const Model model = body_on_ground(kBox, k, kDown);
  const auto end = [&](int n) {
    ContactRun run(model, GetParam(), 0.2 / n, n,
                   six({0.0, 0.0, resting_height(k, 9.81) - 1e-3}, {0.002, -0.001, 0.1}),
                   six({2.0, 0.5, 0.0}, {0.0, 0.0, 0.5}));
    for (const auto& step : contact_history(run.horizon, run.trajectory)) {
      EXPECT_EQ(step[0].active, 4);
      EXPECT_EQ(step[0].sticking, 0);
    }
    VectorXd state(12);
    state << run.q_end(), run.qdot_end();
    return state;
  };
  const int order = find_integrator(GetParam()).order;
  const int n = order == 1 ? 1600 : 400;
  const VectorXd coarse = end(n);
  const VectorXd middle = end(2 * n);
  const VectorXd fine = end(4 * n);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), order, 0.1);
}

INSTANTIATE_TEST_SUITE_P(All, ContactOfEveryIntegrator, ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

}  // namespace
}  // namespace hbar
