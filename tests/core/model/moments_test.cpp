#include "hbar/core/model/moments.h"

#include <gtest/gtest.h>

namespace hbar {
namespace {

TEST(Moments, AreThoseOfABody) {
  EXPECT_EQ(excess_of_moments({1.0, 1.0, 1.0}), 0.0);
  EXPECT_EQ(excess_of_moments({0.1, 0.8, 0.7}), 0.0);  // flat, but for rounding
  EXPECT_NEAR(excess_of_moments({1.0, 1.0, 2.5}), 0.2, 1e-15);
  EXPECT_NEAR(excess_of_moments({0.08333333, 0.08333333, 0.16666667}), 6e-8, 1e-9);
}

}  // namespace
}  // namespace hbar
