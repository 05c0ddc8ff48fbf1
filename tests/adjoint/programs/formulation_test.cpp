#include "hbar/adjoint/programs/formulation.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

TEST(Formulation, IsFoundByItsName) {
  for (const Formulation formulation :
       {Formulation::kShooting, Formulation::kMultipleShooting, Formulation::kAllAtOnce}) {
    EXPECT_EQ(find_formulation(name_of(formulation)), formulation);
  }
  EXPECT_EQ(
      testing::message_of<InvalidInput>([] { static_cast<void>(find_formulation("all_at_once")); }),
      "there is no formulation 'all_at_once'; did you mean 'all-at-once'?");
}

TEST(Formulation, CutsAHorizonIntoSegmentsAsEqualAsStepsAllow) {
  EXPECT_EQ(segment_starts(10, 4), (std::vector<int>{2, 5, 7}));
  EXPECT_EQ(segment_starts(3, 3), (std::vector<int>{1, 2}));
  EXPECT_TRUE(segment_starts(7, 1).empty());
  EXPECT_THROW(static_cast<void>(segment_starts(3, 4)), InvalidInput);
  EXPECT_THROW(static_cast<void>(segment_starts(3, 0)), InvalidInput);
}

}  // namespace
}  // namespace hbar
