#include "hbar/adjoint/design/design_map.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

using testing::kInfinity;
using testing::kNan;
using testing::message_of;

TEST(DesignVariables, AreThoseWrittenDownEachWithAScale) {
  const DesignVariables all = design_variables(
      {{.name = "length", .unit = "m", .start = 2.0, .lower = 1.0, .upper = 5.0},
       {.name = "mass", .unit = "kg", .start = -3.0, .upper = 7.0},
       {.name = "shift", .unit = "m"},
       {.name = "held", .start = 4.0, .lower = 4.0, .upper = 4.0},
       {.name = "chosen", .start = 1.0, .lower = 0.0, .upper = 9.0, .scale = 0.125}});
  EXPECT_EQ(all.size(), 5);
  EXPECT_EQ(all.names, (std::vector<std::string>{"length", "mass", "shift", "held", "chosen"}));
  EXPECT_EQ(all.units, (std::vector<std::string>{"m", "kg", "m", "", ""}));
  Eigen::VectorXd start(5), lower(5), upper(5), scale(5);
  start << 2.0, -3.0, 0.0, 4.0, 1.0;
  lower << 1.0, -kInfinity, -kInfinity, 4.0, 0.0;
  upper << 5.0, 7.0, kInfinity, 4.0, 9.0;
  scale << 1.0, 3.0, 1.0, 4.0, 0.125;
  EXPECT_EQ(all.start, start);
  EXPECT_EQ(all.lower, lower);
  EXPECT_EQ(all.upper, upper);
  EXPECT_EQ(all.scale, scale);
}

TEST(DesignVariables, AreRefusedByName) {
  const auto refusal = [](const DesignVariable& second) {
    return message_of<InvalidInput>([&] {
      static_cast<void>(design_variables({{.name = "a"}, second}));
    });
  };
  EXPECT_EQ(refusal({.name = ""}), "design variable 1 has no name");
  EXPECT_EQ(refusal({.name = "a"}), "design variable 'a': another one has its name");
  EXPECT_EQ(refusal({.name = "b", .start = 2.0, .upper = 1.0}),
            "design variable 'b': start is 2; it must be within its bounds, -inf to 1");
  EXPECT_NE(refusal({.name = "b", .start = kNan}).find("'b': start is nan"), std::string::npos);
  EXPECT_NE(refusal({.name = "b", .lower = kNan}).find("'b': start is 0"), std::string::npos);
  EXPECT_NE(refusal({.name = "b", .scale = -1.0}).find("'b': scale is -1"), std::string::npos);
}

}  // namespace
}  // namespace hbar
