#include "hbar/adjoint/trajectory/horizon.h"

#include <gtest/gtest.h>

#include <limits>

#include "hbar/adjoint/trajectory/memory_estimate.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using testing::make_horizon;
using testing::message_of;
using testing::options_of;

TEST(Horizon, RefusesBadOptions) {
  const Model model = testing::double_pendulum();
  const auto message = [&](const SimulationOptions& options) {
    return message_of<InvalidInput>([&] { make_horizon(model, options); });
  };
  EXPECT_EQ(message(options_of("rk4", 0.1, 3)),
            "there is no integrator 'rk4'; known: bdf1, sdirk2, bdf2");
  EXPECT_EQ(message(options_of("bdf1", 0.0, 3)), "time step h is 0; it must be positive");
  EXPECT_EQ(message(options_of("bdf1", -0.1, 3)), "time step h is -0.1; it must be positive");
  EXPECT_EQ(message(options_of("bdf1", std::numeric_limits<double>::infinity(), 3)),
            "time step h is inf; it must be positive");
  EXPECT_NE(message(options_of("bdf1", std::numeric_limits<double>::quiet_NaN(), 3)), "");
  EXPECT_EQ(message(options_of("bdf1", 1e-321, 3)),
            "time step h is 9.98013e-322; it must be between 1e-120 and 1e+120: its square must be "
            "a number");
  EXPECT_EQ(message(options_of("bdf1", 0.1, 0)), "steps is 0; it must be at least 1");
  EXPECT_EQ(message(options_of("bdf1", 0.1, -5)), "steps is -5; it must be at least 1");
}

TEST(Horizon, RefusesAHorizonThatWouldNotFit) {
  SimulationOptions options = options_of("bdf1", 0.1, 1'000'000'000);
  const std::string message =
      message_of<InvalidInput>([&] { make_horizon(testing::double_pendulum(), options); });
  EXPECT_EQ(
      message,
      "1000000000 steps of 2 coordinates and their gradient take about 332 GB; the limit is 4 "
      "GB: take fewer steps or raise max_memory");
}

TEST(Horizon, DropsFactorsThatWouldNotFit) {
  SimulationOptions options = options_of("bdf1", 0.1, 10);
  const Horizon whole = make_horizon(testing::double_pendulum(), options);
  options.max_memory = estimate_memory(whole).total(false);
  Horizon horizon = make_horizon(testing::double_pendulum(), options);
  EXPECT_TRUE(simulate(horizon, horizon.nominal_inputs()).trajectory().factors.empty());
}

TEST(Horizon, RefusesAModelWithoutCoordinates) {
  EXPECT_EQ(message_of<InvalidInput>([] {
              make_horizon(testing::single_body(FixedJoint{}, testing::kGravity),
                           options_of("bdf1", 0.1, 1));
            }),
            "the model has no coordinate: every joint is fixed");
}

TEST(Horizon, RefusesInputsOfAnotherShapeAndSaysWhich) {
  Horizon horizon =
      make_horizon(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  const auto message = [&](const auto& change) {
    Inputs inputs = horizon.nominal_inputs();
    change(inputs);
    return message_of<InvalidInput>([&] { horizon.check(inputs); });
  };
  const int p = horizon.parameters().size();
  EXPECT_EQ(message([](Inputs& x) { x.p.setZero(3); }),
            concat("p is 3 x 1; it must be ", p, " x 1"));
  EXPECT_EQ(message([](Inputs& x) { x.u.setZero(1, 4); }), "u is 1 x 4; it must be 1 x 5");
  EXPECT_EQ(message([](Inputs& x) { x.q0.setZero(2); }), "q0 is 2 x 1; it must be 1 x 1");
  EXPECT_EQ(message([](Inputs& x) { x.qdot0.resize(0); }), "qdot0 is 0 x 1; it must be 1 x 1");
}

TEST(Horizon, RefusesInputsThatAreNotFinite) {
  Horizon horizon =
      make_horizon(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto message = [&](const auto& change) {
    Inputs inputs = horizon.nominal_inputs();
    change(inputs);
    return message_of<InvalidInput>([&] { horizon.check(inputs); });
  };
  EXPECT_EQ(message([&](Inputs& x) { x.p[1] = nan; }), "p(1, 0) is nan; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.u(0, 3) = infinity; }), "u(0, 3) is inf; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.q0[0] = nan; }), "q0(0, 0) is nan; it must be finite");
  EXPECT_EQ(message([&](Inputs& x) { x.qdot0[0] = -infinity; }),
            "qdot0(0, 0) is -inf; it must be finite");
}

TEST(Horizon, IsSharedByItsCopiesAndUntouchedByWhatIsMadeOfThem) {
  SimulationOptions options = options_of("bdf1", 0.1, 5);
  const Horizon horizon = make_horizon(testing::double_pendulum(), options);
  const Horizon copy = horizon;
  EXPECT_EQ(&copy.model(), &horizon.model());
  EXPECT_EQ(&copy.parameters(), &horizon.parameters());
  options.steps = 7;
  const Horizon longer = copy.with(options);
  EXPECT_EQ(longer.steps(), 7);
  EXPECT_EQ(horizon.steps(), 5);
  EXPECT_EQ(&longer.model(), &horizon.model());
  options.h = -1.0;
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(copy.with(options)); }),
            "time step h is -1; it must be positive");
}

TEST(Horizon, OutlivesWhoMadeIt) {
  Simulator simulator = [] {
    const Horizon here = make_horizon(testing::double_pendulum(), options_of("bdf2", 0.01, 3));
    return Simulator(here);
  }();
  EXPECT_TRUE(simulator.rollout(simulator.horizon().nominal_inputs()).converged());
}

TEST(Horizon, NamesMeasuredRowsAndTheNearestToAWrongName) {
  SimulationOptions options = options_of("bdf1", 0.1, 5);
  options.measurements = {CentreOfMass{"centre"}, LinearMomentum{"momentum"}};
  const Horizon horizon = make_horizon(testing::double_pendulum(), options);
  const std::vector<std::string> names = {"upper.x",  "upper.y",    "upper.z",    "lower.x",
                                          "lower.y",  "lower.z",    "centre.x",   "centre.y",
                                          "centre.z", "momentum.x", "momentum.y", "momentum.z"};
  EXPECT_EQ(horizon.measured_names(), names);
  EXPECT_EQ(horizon.measured_index("momentum.y"), 10);
  EXPECT_EQ(horizon.measured_rows().variables, 6);
  EXPECT_EQ(horizon.measured_rows().tactile, 0);
  options.measurements = {CentreOfMass{"upper"}};
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(horizon.with(options)); }),
            "measurement 'upper': its row 'upper.x' has the name of another; names must differ");
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(horizon.measured_index("centre")); }),
            "there is no measured row 'centre'; did you mean 'centre.x'?");
}

TEST(Horizon, AppliesParametersToTheModelsNumbers) {
  const Horizon horizon =
      make_horizon(testing::slider(1.0, testing::kGravity), options_of("bdf1", 0.1, 5));
  Eigen::VectorXd p = horizon.nominal_inputs().p;
  p[horizon.parameters().find("body.mass.mass")] = 7.0;
  EXPECT_EQ(horizon.mechanism(p)->mass[0], 7.0);
  EXPECT_EQ(horizon.mechanism(horizon.nominal_inputs().p)->mass[0],
            horizon.model().link(0).body.mass);
}

}  // namespace
}  // namespace hbar
