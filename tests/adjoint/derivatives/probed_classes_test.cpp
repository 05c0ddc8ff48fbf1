#include "hbar/adjoint/derivatives/probed_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/small_problems.h"

namespace hbar {
namespace {

TEST(ProbedClasses, HoldEveryInputOnce) {
  const Problem problem = testing::small_problem("bdf1");
  std::set<Eigen::Index> seen;
  for (const ProbedClass& inputs : probed_classes(problem)) {
    ASSERT_EQ(inputs.entries.size(), inputs.scales.size()) << inputs.name;
    for (std::size_t i = 0; i < inputs.entries.size(); ++i) {
      EXPECT_TRUE(seen.insert(inputs.entries[i]).second) << inputs.name;
      EXPECT_GT(inputs.scales[i], 0.0) << inputs.name;
    }
  }
  const Inputs& inputs = problem.inputs;
  EXPECT_EQ(static_cast<Eigen::Index>(seen.size()),
            inputs.p.size() + inputs.u.size() + inputs.q0.size() + inputs.qdot0.size());
  EXPECT_EQ(*seen.rbegin(), static_cast<Eigen::Index>(seen.size()) - 1);
}

/// A slider of the given size, without a number that is free to be chosen but its damping, which
/// is 0.
Problem slider(double length, double time) {
  ModelBuilder builder("slider");
  builder.set_gravity({0.0, 0.0, -length / (time * time)});
  const int link =
      builder.add_link(-1, {.name = "rail", .kind = PrismaticJoint{{0.0, 0.0, 1.0}}},
                       solid_body("ball", Sphere{length},
                                  3.0 / (4.0 * 3.14159265358979) / (length * length * length)));
  builder.add_motor({.link = link});
  const Model model = builder.build();
  const Horizon horizon(model, ParameterSet::named(model, {"joint.rail.damping"}),
                        {.integrator = "bdf1", .h = time / 10.0, .steps = 10});
  return {horizon, Objective(squared_final_position()), horizon.nominal_inputs()};
}

TEST(ProbedClasses, AreMeasuredInTheProblemsOwnUnits) {
  const std::vector<ProbedClass> metres = probed_classes(slider(1.0, 1.0));
  const std::vector<ProbedClass> micrometres = probed_classes(slider(1e-6, 1e-3));
  ASSERT_EQ(metres.size(), 4U);
  // Mass stays 1; damping in mass / time, force, length, length / time.
  const double ratios[] = {1e3, 1.0, 1e-6, 1e-3};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(micrometres[i].scales[0] / metres[i].scales[0], ratios[i], 1e-9 * ratios[i])
        << metres[i].name;
  }
}

}  // namespace
}  // namespace hbar
