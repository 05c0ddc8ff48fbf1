// The snippets of README.md that no example has.

#include <gtest/gtest.h>

#include "hbar/hbar.h"
#include "hbar/umfpack.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

TEST(Readme, HasOneGradientByTwoMethods) {
  const Model model = testing::example_model("arm.xml");
  const Horizon horizon(model, ParameterSet::masked(model),
                        {.integrator = "bdf2", .h = 0.01, .steps = 100});
  const Objective objective(squared_variables());
  const Inputs inputs = horizon.nominal_inputs();

  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  const Gradient dPsi = gradient(horizon, trajectory, objective);
  const Gradient same = gradient(horizon, trajectory, objective, solver_factory("umfpack"));

  testing::expect_same(dPsi, same);
}

}  // namespace
}  // namespace hbar
