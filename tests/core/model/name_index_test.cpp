#include "hbar/core/model/name_index.h"

#include <gtest/gtest.h>

namespace hbar {
namespace {

TEST(NameIndex, GivesNamesTheirOrder) {
  NameIndex names;
  EXPECT_FALSE(names.contains("a"));
  EXPECT_EQ(names.find("a"), std::nullopt);
  names.add("a");
  names.add("");
  names.add("b");
  EXPECT_TRUE(names.contains("b"));
  EXPECT_EQ(names.find("a"), 0);
  EXPECT_EQ(names.find(""), 1);
  EXPECT_EQ(names.find("b"), 2);
  EXPECT_EQ(names.find("c"), std::nullopt);
}

}  // namespace
}  // namespace hbar
