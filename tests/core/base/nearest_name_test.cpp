#include "hbar/core/base/nearest_name.h"

#include <gtest/gtest.h>

namespace hbar {
namespace {

const std::vector<std::string> kNames = {"revolute", "prismatic", "planar", "fixed"};

TEST(NearestName, HasTheSmallestEditDistance) {
  EXPECT_EQ(nearest_name("revolut", kNames), "revolute");
  EXPECT_EQ(nearest_name("prysmatic", kNames), "prismatic");
  EXPECT_EQ(nearest_name("planer", kNames), "planar");
  EXPECT_EQ(nearest_name("mixed", kNames), "fixed");
  EXPECT_EQ(nearest_name("", kNames), "fixed");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, CountsInsertionsDeletionsAndSubstitutionsAlike) {
  // The first candidate needs two edits, the second one: the first would win a tie.
  EXPECT_EQ(nearest_name("abcd", {"abXXcd", "abc"}), "abc");
  EXPECT_EQ(nearest_name("abcd", {"aXXd", "abXcd"}), "abXcd");
  EXPECT_EQ(nearest_name("abcd", {"abcdXX", "abcX"}), "abcX");
}

TEST(UnknownNameHint, SuggestsANearNameAndListsTheRestOtherwise) {
  EXPECT_EQ(unknown_name_hint("revolut", kNames), "did you mean 'revolute'?");
  EXPECT_EQ(unknown_name_hint("spherical-exp", kNames),
            "known: revolute, prismatic, planar, fixed");
  EXPECT_EQ(unknown_name_hint("anything", {}), "there are none");
  const std::vector<std::string> many(13, "something");
  std::string listed = "known: something";
  for (int i = 1; i < 12; ++i) {
    listed += ", something";
  }
  EXPECT_EQ(unknown_name_hint("else", many), listed + ", …");
}

}  // namespace
}  // namespace hbar
