#include "hbar/adjoint/trajectory/memory_estimate.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/geometry/surface_points.h"
#include "tests/support/allocation_counters.h"
#include "tests/support/message_of.h"
#include "tests/support/scenes.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

/// What a model of the table has.
struct Size {
  int dof;
  int motors = 0;
  int end_effectors = 0;
  int sensor_points = 0;
  bool contact = false;
};

/// A chain of hinged boxes in no gravity.
Model chain(const Size& size) {
  ModelBuilder builder("chain");
  builder.set_gravity(Eigen::Vector3d::Zero());
  for (int i = 0; i < size.dof; ++i) {
    Joint joint{.name = concat("joint", i), .kind = RevoluteJoint{{0.0, 1.0, 0.1 * (i % 3)}}};
    joint.X_PJ.p = {i == 0 ? 0.0 : 0.2, 0.0, 0.0};
    Body body = solid_body(concat("box", i), Cuboid{{0.2, 0.05, 0.05}}, 500.0);
    body.contact_points = surface_points(body.shape, {});
    builder.add_link(i - 1, joint, body);
  }
  for (int i = 0; i < size.motors; ++i) {
    builder.add_motor({.link = i});
  }
  for (int i = 0; i < size.end_effectors; ++i) {
    builder.add_end_effector({.link = i % size.dof});
  }
  if (size.contact) {
    Contact contact{.link = 0, .other = -1};
    contact.surface = Plane{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}};
    builder.add_contact(contact);
  }
  if (size.sensor_points > 0) {
    TactileSensor sensor;
    sensor.points = Eigen::Matrix3Xd::Zero(3, size.sensor_points);
    sensor.axis0 = Eigen::Vector3d::UnitX().replicate(1, size.sensor_points);
    sensor.axis1 = Eigen::Vector3d::UnitY().replicate(1, size.sensor_points);
    builder.add_tactile_sensor(sensor);
  }
  return builder.build();
}

/// What a simulation and its gradient allocate at most, over what was estimated.
double allocated_over_estimated(const Model& model, const SimulationOptions& options,
                                const ParameterSet& parameters) {
  const Horizon horizon(model, parameters, options);
  const Inputs inputs = horizon.nominal_inputs();
  const Objective objective(model.variable_count() > 0 ? squared_variables()
                                                       : squared_final_position());
  const double peak = testing::peak_bytes_of([&] {
    const Trajectory trajectory = simulate(horizon, inputs).trajectory();
    static_cast<void>(gradient(horizon, trajectory, objective));
  });
  return peak / estimate_memory(horizon).total(horizon.keeps_factors());
}

constexpr double kFactor = 1.3;

TEST(MemoryEstimate, IsWithinAFactorOfWhatSimulationAndGradientAllocate) {
  if (!testing::kCountsBytes) {
    GTEST_SKIP() << "a sanitizer's allocator is not counted";
  }
  const std::vector<Size> sizes = {
      {1},         {2, 2, 2},   {5, 5, 1}, {7, 7, 0, 0, true}, {3, 1, 1, 40, true},
      {20, 20, 1}, {60, 60, 60}};
  for (const Size& size : sizes) {
    const Model model = chain(size);
    for (const std::string integrator : {"bdf1", "sdirk2", "bdf2"}) {
      for (const bool keep : {true, false}) {
        for (const bool all : {true, false}) {
          SimulationOptions options =
              testing::options_of(integrator, 0.01, size.dof > 10 ? 50 : 1000);
          options.keep_factors = keep;
          const ParameterSet set = all ? ParameterSet::all(model) : ParameterSet::masked(model);
          const double ratio = allocated_over_estimated(model, options, set);
          EXPECT_LT(ratio, kFactor) << size.dof << ' ' << integrator << ' ' << keep << ' ' << all;
          EXPECT_GT(ratio, 1.0 / kFactor)
              << size.dof << ' ' << integrator << ' ' << keep << ' ' << all;
        }
      }
    }
  }
}

TEST(MemoryEstimate, KnowsJointsOfSeveralCoordinates) {
  if (!testing::kCountsBytes) {
    GTEST_SKIP() << "a sanitizer's allocator is not counted";
  }
  const Model model = testing::small_model();
  for (const int steps : {1, 100}) {
    const double ratio = allocated_over_estimated(model, testing::options_of("bdf2", 0.001, steps),
                                                  ParameterSet::all(model));
    EXPECT_LT(ratio, kFactor) << steps;
    EXPECT_GT(ratio, 1.0 / kFactor) << steps;
  }
}

TEST(MemoryEstimate, GrowsWithStepsInAllButTheWorkspace) {
  const Model model = chain({4, 2, 1});
  const auto of = [&](int steps) {
    return estimate_memory(model, {.integrator = "bdf1", .steps = steps, .measured = 3});
  };
  const MemoryEstimate one = of(1000);
  const MemoryEstimate ten = of(10'000);
  EXPECT_EQ(one.workspace, ten.workspace);
  EXPECT_NEAR(ten.trajectory / one.trajectory, 10.0, 0.05);
  EXPECT_NEAR(ten.factors / one.factors, 10.0, 0.05);
  EXPECT_NEAR(ten.gradient / one.gradient, 10.0, 0.05);
}

TEST(MemoryEstimate, RefusesWhatWouldNotFitAndSaysWhatHelps) {
  const Model model = chain({2});
  const MemoryEstimate estimate{1e6, 3e9, 9e9, 2e9};
  const auto message = [&](double limit) {
    return testing::message_of<InvalidInput>([&] { require_memory(model, 1000, estimate, limit); });
  };
  EXPECT_EQ(message(4e9),
            "1000 steps of 2 coordinates and their gradient take about 5.001 GB; the limit is 4 "
            "GB: take fewer steps or raise max_memory");
  EXPECT_EQ(message(5.1e9), "") << "factors are not counted";
  EXPECT_EQ(
      message(1e5),
      "one step of 2 coordinates takes about 0.001 GB; the limit is 0.0001 GB: take a smaller "
      "model or raise max_memory");
}

}  // namespace
}  // namespace hbar
