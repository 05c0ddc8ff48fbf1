#include <gtest/gtest.h>

TEST(Tested, Asserts) { EXPECT_EQ(tested(), 1); }

// planted: asserts
TEST(Tested, OnlyRuns) {
  tested();  // EXPECT_EQ in a comment does not count
}

TEST(Tested, AssertsInAHelper) { expect_tested(); }
