#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hbar::scene {

/// The words of a text: what lies between blanks, tabs and line ends.
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view text);

/// A decimal number, whatever the locale: the whole word, finite, in the range of a double.
///
/// @param word    what to read
/// @param reason  set to a clause that says what is wrong with it, if anything is
/// @returns       the number, or nothing
[[nodiscard]] std::optional<double> parse_number(std::string_view word, std::string& reason);

/// A whole number in the range of an int; as parse_number.
[[nodiscard]] std::optional<int> parse_integer(std::string_view word, std::string& reason);

/// The shortest decimal text that reads back as the same double, whatever the locale.
[[nodiscard]] std::string format_number(double value);

/// A text as it can stand in a message: at most 60 characters, control characters written \xNN.
[[nodiscard]] std::string quotable(std::string_view text);

}  // namespace hbar::scene
