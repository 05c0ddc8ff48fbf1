#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/core/parameters/parameters.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::message_of;

TEST(RequireInRange, RefusesNegativeStiffnessDampingAndGains) {
  ModelBuilder builder("m");
  const int link = builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{{0, 0, 1}}},
                                    solid_body("b", Sphere{1.0}, 1.0));
  builder.add_motor({.link = link, .kind = Motor::Kind::kPosition, .P = 2.0, .D = 1.0});
  const Model model = builder.build();
  for (const char* name : {"joint.j.stiffness", "joint.j.damping", "motor.j.P", "motor.j.D"}) {
    const ParameterSet set = ParameterSet::named(model, {name});
    const auto message = [&set](double value) {
      return message_of<InvalidInput>([&] { require_in_range(set, VectorXd::Constant(1, value)); });
    };
    EXPECT_EQ(message(-1.0), concat(name, " is -1; it must be ≥ 0"));
    EXPECT_EQ(message(-1e-9), concat(name, " is -1e-09; it must be ≥ 0"));
    EXPECT_EQ(message(0.0), "");
    VectorXd relaxed = VectorXd::Constant(1, -1e-9);  // as an optimiser's bound is
    round_into_range(set, relaxed);
    EXPECT_EQ(relaxed[0], 0.0);
    relaxed[0] = -1e-3;
    round_into_range(set, relaxed);
    EXPECT_EQ(relaxed[0], -1e-3);
  }
}

}  // namespace
}  // namespace hbar
