#include "hbar/core/files/row_checksum.h"

#include <gtest/gtest.h>

#include <string>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"

namespace hbar::scene {
namespace {

std::string refusal(const std::string& line) {
  CsvRow row = parse_csv(line, "t.csv").at(0);
  return testing::message_of<InvalidInput>([&] { take_checksum(row, "t.csv"); });
}

TEST(RowChecksum, IsTakenOffAgain) {
  const std::string line = "variable,\"length, m\",0.5";
  CsvRow row = parse_csv(with_checksum(line), "t.csv").at(0);
  ASSERT_EQ(row.size(), 4U);
  take_checksum(row, "t.csv");
  ASSERT_EQ(row.size(), 3U);
  EXPECT_EQ(row[1].text, "length, m");
}

// The 64-bit FNV-1a hash of "a", as published with the algorithm, is af63dc4c8601ec8c; that of "a"
// and a zero byte follows by hand: (af63dc4c8601ec8c xor 0) times 100000001b3 modulo 2^64.
TEST(RowChecksum, IsThatOfThePublishedHash) {
  constexpr std::uint64_t kSum = 0xaf63dc4c8601ec8cULL * 0x100000001b3ULL;
  constexpr auto kFolded = static_cast<std::uint32_t>(kSum ^ (kSum >> 32));
  const std::string found = with_checksum("a").substr(2);
  EXPECT_EQ(std::stoul(found, nullptr, 16), kFolded);
}

TEST(RowChecksum, FindsEveryChangeOfOneCharacter) {
  const std::string line = with_checksum("constraint,reach,-0.125");
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (const char c : {'0', '7', 'x'}) {
      std::string spoiled = line;
      spoiled[at] = c;
      EXPECT_EQ(refusal(spoiled).empty(), spoiled == line) << spoiled;
    }
  }
  EXPECT_EQ(refusal("constraint,reach,-0.125,"), "") << "edited by hand";
}

}  // namespace
}  // namespace hbar::scene
