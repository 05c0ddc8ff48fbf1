#include "hbar/solvers/linear/mutual_exclusion.h"

#include <gtest/gtest.h>

#include <future>

namespace hbar::solvers {
namespace {

TEST(MutualExclusion, IsGivenBackInBetween) {
  std::unique_lock<std::mutex> lock(mumps_mutex());
  const auto is_free = [] {
    return std::async(std::launch::async,
                      [] {
                        const std::unique_lock<std::mutex> other(mumps_mutex(), std::try_to_lock);
                        return other.owns_lock();
                      })
        .get();
  };
  EXPECT_FALSE(is_free());
  {
    const Unlocked in_between(lock);
    EXPECT_TRUE(is_free());
  }
  EXPECT_FALSE(is_free());
}

}  // namespace
}  // namespace hbar::solvers
