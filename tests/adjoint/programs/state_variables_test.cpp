#include "hbar/adjoint/programs/state_variables.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

TEST(StateVariables, HaveNamesAndTypicalSizes) {
  TrajectoryProblem problem{.horizon = testing::make_horizon(testing::double_pendulum(),
                                                             testing::options_of("bdf2", 0.02, 3)),
                            .map = nullptr,
                            .objective = {},
                            .constraints = {},
                            .controls = {},
                            .q0 = {},
                            .qdot0 = {}};
  EXPECT_EQ(state_names(problem.horizon.model()),
            (std::vector<std::string>{"shoulder", "elbow", "shoulder rate", "elbow rate"}));
  EXPECT_EQ(state_scale(problem), Eigen::Vector4d::Ones());
  problem.q_scale = Eigen::Vector2d(2.0, 3.0);
  problem.qdot_scale = Eigen::Vector2d(5.0, 7.0);
  EXPECT_EQ(state_scale(problem), Eigen::Vector4d(2.0, 3.0, 5.0, 7.0));
  problem.qdot_scale = Eigen::Vector3d::Ones();
  EXPECT_EQ(testing::message_of<InvalidInput>([&] { static_cast<void>(state_scale(problem)); }),
            "TrajectoryProblem: qdot_scale has 3 entries; it must have 2");
}

}  // namespace
}  // namespace hbar
