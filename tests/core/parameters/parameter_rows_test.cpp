#include "hbar/core/parameters/parameter_rows.h"

#include <gtest/gtest.h>

#include "hbar/core/parameters/parameter_kinds.h"
#include "hbar/core/parameters/parameters.h"
#include "tests/core/parameters/two_limbs.h"

namespace hbar {
namespace {

TEST(ParameterRows, AreThoseOfTheContactsThatAParameterChanges) {
  const Model model = testing::two_limbs();
  const auto rows = [&](const std::string& name) {
    const ParameterSet set = ParameterSet::named(model, {name});
    return parameter_rows(model, set.blocks()[0]);
  };
  using Rows = std::vector<int>;
  // By name: own path, and what contacts of the bodies that it moves couple.
  const std::vector<std::pair<std::string, Rows>> expected = {
      {"joint.leg.rotation", {0, 2}},
      {"joint.arm.rotation", {0, 1, 3, 4, 5}},
      {"body.leg.rotation", {0, 2}},
      {"body.arm.rotation", {0, 1, 3, 4, 5}},
      {"body.arm.mass", {0, 1}},
      {"body.leg.size", {0, 2}},
      {"body.stone.size", {0, 1, 3, 4, 5}},
      {"body.arm.contact", {0, 1, 3, 4, 5}},
      {"body.stone.contact", {3, 4, 5}},
      {"body.stone.contact_scale", {3, 4, 5}},
      {"contact.arm-stone", {0, 1, 3, 4, 5}},
      {"contact.stone-ground", {3, 4, 5}}};
  for (const auto& [name, of_name] : expected) {
    EXPECT_EQ(rows(name), of_name) << name;
  }
}

}  // namespace
}  // namespace hbar
