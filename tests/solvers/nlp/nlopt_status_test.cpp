#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "hbar/solvers/nlp/nlopt.h"

namespace hbar::solvers {
namespace {

TEST(NloptStatus, EveryStatusHasItsOwnWordsAndAdviceUnlessOptimal) {
  std::set<std::string_view> words;
  const int count = static_cast<int>(NloptStatus::kFailed) + 1;
  for (int k = 0; k < count; ++k) {
    const auto status = static_cast<NloptStatus>(k);
    words.insert(to_string(status));
    EXPECT_EQ(advice(status).empty(), status == NloptStatus::kOptimal) << to_string(status);
  }
  EXPECT_EQ(words.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(words.count("unknown"), 0U);
}

}  // namespace
}  // namespace hbar::solvers
