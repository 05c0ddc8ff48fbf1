// Words, numbers and lists, as every text file and option has them.

#include "hbar/core/files/numbers.h"

#include <cmath>

#include "examples/tool/entries.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

/// Numbers are finite, and the text of one reads back as the same bits.
void check_number(std::string_view word) {
  std::string reason;
  const std::optional<double> number = scene::parse_number(word, reason);
  require(number.has_value() == reason.empty(), "a refusal without a reason, or a reason without");
  if (number) {
    const std::string text = scene::format_number(*number);
    const std::optional<double> again = scene::parse_number(text, reason);
    require(std::isfinite(*number), "a number that is not finite");
    require(again == number && std::signbit(*again) == std::signbit(*number),
            "\"" + text + "\" is another number");
  }
  std::string integer_reason;
  const std::optional<int> integer = scene::parse_integer(word, integer_reason);
  require(integer.has_value() == integer_reason.empty(), "a refusal of an integer without reason");
  require(!integer || number == *integer, "an integer that is another number");
}

void check_quotable(std::string_view text) {
  const std::string quoted = scene::quotable(text);
  require(quoted.size() <= 4 * 60 + 3, "a quotation that is long");
  for (const char c : quoted) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "a control character in a message");
  }
}

}  // namespace

void try_input(std::string_view input) {
  check_number(input);
  check_quotable(input);
  for (const std::string_view word : scene::split_words(input)) {
    require(!word.empty() && scene::split_words(word).size() == 1, "a word that is none");
    check_number(word);
    check_quotable(word);
  }
  std::string reason;
  const std::vector<double> numbers = tool::parse_numbers(input, reason);
  require(numbers.empty() || reason.empty(), "numbers with a reason against them");
  std::string list;
  for (const double number : numbers) {
    list += (list.empty() ? "" : ", ") + scene::format_number(number);
  }
  require(tool::parse_numbers(list, reason) == numbers, "a list of numbers that is another one");
}

}  // namespace hbar::fuzz
