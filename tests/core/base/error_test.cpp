#include "hbar/core/base/error.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace hbar {
namespace {

template <typename... Parts>
std::string streamed(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

TEST(EveryError, IsAnErrorWithItsMessage) {
  EXPECT_THROW(throw InvalidInput("a"), Error);
  EXPECT_THROW(throw IoError("b"), Error);
  EXPECT_THROW(throw NumericalFailure("c"), Error);
  EXPECT_THROW(throw Interrupted("d"), Error);
  EXPECT_STREQ(InvalidInput("where: what").what(), "where: what");
}

TEST(Concat, WritesNumbersAsStreamsDo) {
  for (const double number :
       {0.0, -0.0, 1.0, 0.1, 1.0 / 3.0, 1e-300, -123456.7, 1234567.0, 1e100,
        std::numeric_limits<double>::infinity(), std::numeric_limits<double>::denorm_min()}) {
    EXPECT_EQ(concat(number), streamed(number));
    EXPECT_EQ(concat(static_cast<float>(number)), streamed(static_cast<float>(number)));
  }
  EXPECT_EQ(concat(std::numeric_limits<long long>::min(), ' ',
                   std::numeric_limits<unsigned long long>::max(), ' ', -7, ' ', 7U, ' ',
                   std::size_t{3}, ' ', true),
            streamed(std::numeric_limits<long long>::min(), ' ',
                     std::numeric_limits<unsigned long long>::max(), ' ', -7, ' ', 7U, ' ',
                     std::size_t{3}, ' ', true));
}

TEST(Concat, JoinsEveryKindOfText) {
  const std::string text(500, 'x');
  const char* const pointer = "pointer";
  EXPECT_EQ(concat("a", 'b', std::string_view("c"), text, pointer, std::string("temporary"), ""),
            "abc" + text + "pointertemporary");
  EXPECT_EQ(concat(), "");
}

// A decimal comma and grouped digits, as some locales have them.
struct Commas : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Concat, KnowsNoLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new Commas));
  const std::string text = concat(1234567, ' ', 2.5);
  std::locale::global(before);
  EXPECT_EQ(text, "1234567 2.5");
}

TEST(Listed, PutsBlanksBetween) {
  EXPECT_EQ(listed(Eigen::Vector3d(1.0, -0.5, 1e-9)), "1 -0.5 1e-09");
  EXPECT_EQ(listed(std::vector<int>{}), "");
  EXPECT_EQ(listed(std::vector<std::string>{"one", "two"}), "one two");
}

}  // namespace
}  // namespace hbar
