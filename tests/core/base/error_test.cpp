#include "hbar/core/base/error.h"

#include <gtest/gtest.h>

namespace hbar {
namespace {

TEST(EveryError, IsAnErrorWithItsMessage) {
  EXPECT_THROW(throw InvalidInput("a"), Error);
  EXPECT_THROW(throw IoError("b"), Error);
  EXPECT_THROW(throw NumericalFailure("c"), Error);
  EXPECT_STREQ(InvalidInput("where: what").what(), "where: what");
}

TEST(Concat, JoinsWhatStreamsWrite) { EXPECT_EQ(concat("a", 1, '-', 2.5), "a1-2.5"); }

}  // namespace
}  // namespace hbar
