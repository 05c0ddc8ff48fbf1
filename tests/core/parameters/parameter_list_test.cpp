#include "hbar/core/parameters/parameter_list.h"

#include <gtest/gtest.h>

#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

/// What a row of the table lists is of its own kind and of the owner asked for, named after that,
/// with its nominal value between its bounds.
TEST(ParameterList, IsOfTheKindAndOwnerThatWereAskedFor) {
  const Model model = testing::random_contact_model(3);
  for (const ParameterKindRow& row : parameter_kinds()) {
    detail::ParameterList out;
    const int owner = row.owner == ParameterOwner::kModel || row.owner == ParameterOwner::kMotor
                          ? 0  // the first motor is one with gains
                          : 1;
    row.list(model, owner, out);
    EXPECT_FALSE(out.empty()) << row.name;
    for (std::size_t i = 0; i < out.size(); ++i) {
      EXPECT_EQ(out[i].kind, row.kind) << out[i].name;
      EXPECT_EQ(out[i].owner, owner) << out[i].name;
      EXPECT_FALSE(out[i].unit.empty()) << out[i].name;
      EXPECT_LE(out[i].lower, out[i].nominal) << out[i].name;
      EXPECT_LE(out[i].nominal, out[i].upper) << out[i].name;
      EXPECT_TRUE(i == 0 || out[i - 1].component < out[i].component) << out[i].name;
    }
  }
}

}  // namespace
}  // namespace hbar
