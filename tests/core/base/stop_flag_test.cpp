#include "hbar/core/base/stop_flag.h"

#include <gtest/gtest.h>

#include "tests/support/message_of.h"

namespace hbar {
namespace {

TEST(StopFlag, IsSetWhereItIsThereAndTrue) {
  std::atomic<bool> stop = false;
  EXPECT_FALSE(is_set(nullptr));
  EXPECT_FALSE(is_set(&stop));
  stop = true;
  EXPECT_TRUE(is_set(&stop));
}

TEST(StopFlag, EndsWhatRunsWithWhereItWas) {
  std::atomic<bool> stop = false;
  EXPECT_NO_THROW(require_running(nullptr, "sweep"));
  EXPECT_NO_THROW(require_running(&stop, "sweep"));
  stop = true;
  EXPECT_EQ(testing::message_of<Interrupted>(
                [&] { require_running(&stop, "sweep interrupted at stage ", 3, " of ", 7); }),
            "sweep interrupted at stage 3 of 7");
}

}  // namespace
}  // namespace hbar
