#include "hbar/core/files/numbers.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <locale>
#include <string>

namespace hbar::scene {
namespace {

/// A locale that writes decimals with a comma, for C++ streams; where the system has a German one
/// it is set for C functions too.
class CommaLocale {
 public:
  CommaLocale()
      : old_c_(std::setlocale(LC_ALL, nullptr)),
        old_cpp_(std::locale::global(std::locale(std::locale::classic(), new Comma))) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) {
        break;
      }
    }
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::locale::global(old_cpp_);
    std::setlocale(LC_ALL, old_c_.c_str());
  }

 private:
  struct Comma : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
  };
  std::string old_c_;
  std::locale old_cpp_;
};

TEST(Numbers, AreReadWhole) {
  std::string reason;
  for (const auto& [word, value] : {std::pair<const char*, double>{"1", 1.0},
                                    {"-2.5", -2.5},
                                    {"+3", 3.0},
                                    {"0.", 0.0},
                                    {".5", 0.5},
                                    {"1e-3", 1e-3},
                                    {"1E3", 1e3},
                                    {"5e-324", 5e-324}}) {
    EXPECT_EQ(parse_number(word, reason), value) << word;
  }
  for (const char* word : {"", "1x", "x", "1,5", "0x10", "nan", "-nan", "inf", "infinity", "1e999",
                           "1e-999", "++1", "+-1", "1 ", "--1", "1.5.2", "+"}) {
    EXPECT_EQ(parse_number(word, reason), std::nullopt) << word;
    EXPECT_FALSE(reason.empty());
  }
}

TEST(Numbers, SayWhatIsWrong) {
  std::string reason;
  EXPECT_FALSE(parse_number("abc", reason));
  EXPECT_EQ(reason, "\"abc\" is not a finite number");
  EXPECT_FALSE(parse_number("1e999", reason));
  EXPECT_EQ(reason, "\"1e999\" is too large or too small");
  EXPECT_FALSE(parse_integer("2147483648", reason));
  EXPECT_EQ(reason, "\"2147483648\" is too large or too small");
  EXPECT_FALSE(parse_integer("1.0", reason));
  EXPECT_EQ(reason, "\"1.0\" is not a whole number");
  EXPECT_EQ(parse_integer("-2147483648", reason), std::numeric_limits<int>::min());
}

TEST(Numbers, AreWrittenSoThatTheyReadBack) {
  std::string reason;
  double value = 1.0;
  for (int i = 0; i < 1000; ++i) {
    value = std::fmod(value * 1103.515245 + 0.12345, 1e6) * (i % 2 == 0 ? 1e-9 : -1e9);
    EXPECT_EQ(parse_number(format_number(value), reason), value);
  }
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(-980.0), "-980");
}

TEST(Numbers, DoNotDependOnTheLocale) {
  const CommaLocale comma;
  std::string reason;
  EXPECT_EQ(parse_number("1.5", reason), 1.5);
  EXPECT_EQ(parse_number("1,5", reason), std::nullopt);
  EXPECT_EQ(format_number(1.5), "1.5");
}

TEST(Words, AreSeparatedByBlanks) {
  const auto words = split_words(" a\tbc\r\n d ");
  EXPECT_EQ(words, (std::vector<std::string_view>{"a", "bc", "d"}));
  EXPECT_TRUE(split_words(" \n").empty());
}

TEST(Quotable, IsShortAndPrintable) {
  EXPECT_EQ(quotable("a\nb"), "a\\x0ab");
  EXPECT_EQ(quotable(std::string(61, 'x')), std::string(60, 'x') + "...");
}

}  // namespace
}  // namespace hbar::scene
