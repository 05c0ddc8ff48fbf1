#include "hbar/adjoint/trajectory/check_trajectory.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

// tests/system/misuse_test.cpp has what is refused, by everything that takes a trajectory.

TEST(CheckTrajectory, AcceptsThoseOfTheSameHorizonOrAnEqualOne) {
  const Horizon horizon =
      testing::make_horizon(testing::double_pendulum(), testing::options_of("bdf2", 0.01, 20));
  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();
  EXPECT_NO_THROW(require_whole_trajectory_of(horizon, trajectory));
  const Horizon equal =
      testing::make_horizon(testing::double_pendulum(), testing::options_of("bdf2", 0.01, 20));
  EXPECT_NO_THROW(require_whole_trajectory_of(equal, trajectory));
  // How it was solved is nobody's business.
  SimulationOptions tighter = horizon.options();
  tighter.newton.rtol = 1e-14;
  EXPECT_NO_THROW(require_whole_trajectory_of(horizon.with(tighter), trajectory));
}

TEST(CheckTrajectory, TellsAPartFromAWhole) {
  const Horizon whole =
      testing::make_horizon(testing::double_pendulum(), testing::options_of("bdf1", 0.01, 20));
  Trajectory part = simulate(whole, whole.nominal_inputs()).trajectory();
  part.timeline = even_timeline(whole.integrator(), 0.01, 12);
  part.q.conservativeResize(Eigen::NoChange, 13);
  part.qdot.conservativeResize(Eigen::NoChange, 13);
  EXPECT_NO_THROW(require_trajectory_of(whole, part));
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { require_whole_trajectory_of(whole, part); }),
            "the trajectory has 12 of 20 steps; this needs a whole one, which Rollout::trajectory "
            "gives or refuses");
}

}  // namespace
}  // namespace hbar
