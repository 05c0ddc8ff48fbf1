#include "hbar/core/files/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// A leading plus is allowed in files and unknown to from_chars.
std::string_view without_plus(std::string_view word) {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return plus ? word.substr(1) : word;
}

template <typename Number>
std::optional<Number> parse(std::string_view word, const char* what, std::string& reason) {
  const std::string_view digits = without_plus(word);
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::result_out_of_range && whole) {
    reason = concat("\"", quotable(word), "\" is too large or too small");
    return std::nullopt;
  }
  if (error != std::errc() || !whole || !std::isfinite(static_cast<double>(value))) {
    reason = concat("\"", quotable(word), "\" is not ", what);
    if (word.find(',') != std::string_view::npos) {
      reason += " (decimals take a point, entries are separated by blanks)";
    }
    return std::nullopt;
  }
  return value;
}

}  // namespace

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (i < text.size()) {
    while (i < text.size() && is_blank(text[i])) {
      ++i;
    }
    const std::size_t begin = i;
    while (i < text.size() && !is_blank(text[i])) {
      ++i;
    }
    if (i > begin) {
      words.push_back(text.substr(begin, i - begin));
    }
  }
  return words;
}

std::optional<double> parse_number(std::string_view word, std::string& reason) {
  return parse<double>(word, "a finite number", reason);
}

std::optional<int> parse_integer(std::string_view word, std::string& reason) {
  return parse<int>(word, "a whole number", reason);
}

std::string format_number(double value) {
  std::array<char, 40> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string quotable(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      out += c;
    } else {
      out += {'\\', 'x', kDigits[byte / 16U], kDigits[byte % 16U]};
    }
  }
  if (text.size() > kLongest) {
    out += "...";
  }
  return out;
}

}  // namespace hbar::scene
