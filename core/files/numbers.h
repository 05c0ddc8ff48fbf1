#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hbar::scene {

/// The words of a text, separated by blanks, tabs and line ends.
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view text);

/// Parses a decimal number, independent of the locale: the whole word, finite, in the range of a
/// double.
///
/// @param word    what to read
/// @param reason  set to a clause that says what is wrong, if anything is
/// @returns       the number, or nothing
[[nodiscard]] std::optional<double> parse_number(std::string_view word, std::string& reason);

/// A whole number in the range of an int; as parse_number.
[[nodiscard]] std::optional<int> parse_integer(std::string_view word, std::string& reason);

/// The shortest decimal text that reads back as the same double, independent of the locale.
[[nodiscard]] std::string format_number(double value);

/// A text made fit for a message: at most 60 characters, control characters written \xNN.
[[nodiscard]] std::string quotable(std::string_view text);

}  // namespace hbar::scene
