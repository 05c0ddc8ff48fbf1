// The same input gives the same bits: again, from another simulator, and on every thread.

#include <gtest/gtest.h>

#include <thread>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

/// A trajectory and a gradient, bit for bit.
struct Outcome {
  Eigen::MatrixXd q;
  Eigen::MatrixXd qdot;
  Gradient gradient;

  friend bool operator==(const Outcome& a, const Outcome& b) {
    return a.q == b.q && a.qdot == b.qdot && a.gradient.value == b.gradient.value &&
           a.gradient.p == b.gradient.p && a.gradient.u == b.gradient.u &&
           a.gradient.q0 == b.gradient.q0 && a.gradient.qdot0 == b.gradient.qdot0;
  }
};

Simulator make_simulator(const Model& model, const std::string& integrator) {
  SimulationOptions options;
  options.integrator = integrator;
  options.h = 0.01;
  options.steps = 6;
  return Simulator({model, ParameterSet::all(model), options});
}

Outcome run(Simulator& simulator) {
  const Horizon& horizon = simulator.horizon();
  const Model& model = horizon.model();
  testing::Random random(7);
  Inputs inputs = horizon.nominal_inputs();
  inputs.u = 0.5 * random.matrix(model.control_count(), 6);
  inputs.q0 = random.vector(model.dof(), 0.3);
  inputs.qdot0 = random.vector(model.dof(), 0.5);
  const Trajectory trajectory = simulator.rollout(inputs).trajectory();
  Objective objective(squared_variables());
  objective.add(squared_velocity());
  return {trajectory.q, trajectory.qdot, gradient(horizon, trajectory, objective)};
}

class SameBits : public ::testing::TestWithParam<std::string> {};

TEST_P(SameBits, AgainAndFromAnotherSimulator) {
  const Model model = testing::random_model(41);
  Simulator simulator = make_simulator(model, GetParam());
  const Outcome first = run(simulator);
  EXPECT_TRUE(run(simulator) == first);
  const Model copy = model;
  Simulator other = make_simulator(copy, GetParam());
  EXPECT_TRUE(run(other) == first);
  Simulator moved = std::move(other);
  EXPECT_TRUE(run(moved) == first);
}

TEST_P(SameBits, WhateverWasComputedBefore) {
  const Model model = testing::random_model(41);
  Simulator fresh = make_simulator(model, GetParam());
  Simulator used = make_simulator(model, GetParam());
  Inputs other = used.horizon().nominal_inputs();
  other.q0.setConstant(0.2);
  other.p.array() += 0.001;
  EXPECT_TRUE(used.rollout(other).converged());
  EXPECT_TRUE(run(used) == run(fresh));
}

TEST_P(SameBits, OnOneTwoAndEightThreads) {
  const Model model = testing::random_model(41);
  Simulator here = make_simulator(model, GetParam());
  const Outcome expected = run(here);
  for (const std::size_t count : {1U, 2U, 8U}) {
    std::vector<char> same(count, 0);
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < count; ++i) {
        threads.emplace_back([&, i] {
          Simulator simulator = make_simulator(model, GetParam());
          same[i] = run(simulator) == expected ? 1 : 0;
        });
      }
    }
    EXPECT_EQ(same, std::vector<char>(count, 1)) << count << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(All, SameBits, ::testing::Values("bdf1", "sdirk2", "bdf2"),
                         [](const auto& run) { return run.param; });

}  // namespace
}  // namespace hbar
