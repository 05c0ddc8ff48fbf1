#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::scene {

/// Calls `line(number, words)` for each line of a text that has words before its comment, which
/// begins with #. A byte order mark is skipped. A line that ends with \ goes on in the next, and
/// has the number of the first.
///
/// @returns the number of the last line that has words; 0 if none has
template <typename Line>
int for_each_line(std::string_view text, Line&& line) {
  if (text.starts_with("\xef\xbb\xbf")) {
    text.remove_prefix(3);
  }
  int number = 0;
  int first = 0;  // of a line that goes on
  int last = 0;
  std::vector<std::string_view> words;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    std::vector<std::string_view> more =
        split_words(whole.substr(0, std::min(whole.find('#'), whole.size())));
    const bool goes_on = !more.empty() && more.back().ends_with('\\');
    if (goes_on) {
      more.back().remove_suffix(1);
      if (more.back().empty()) {
        more.pop_back();
      }
    }
    first = words.empty() ? number : first;
    words.insert(words.end(), more.begin(), more.end());
    if (goes_on || words.empty()) {
      continue;
    }
    line(first, words);
    last = first;
    words.clear();
  }
  if (!words.empty()) {
    line(first, words);
    last = first;
  }
  return last;
}

/// Throws InvalidInput that begins `name:line: `.
[[noreturn]] inline void fail_in_line(const std::string& name, int line, const std::string& what) {
  throw InvalidInput(concat(name, ":", line, ": ", what));
}

/// Three numbers among words, from word `first` on.
/// @throws InvalidInput that begins `name:line: ` if one is none
[[nodiscard]] inline Eigen::Vector3d point_in_words(const std::vector<std::string_view>& words,
                                                    std::size_t first, const std::string& name,
                                                    int line) {
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    std::string reason;
    const std::optional<double> value = parse_number(words[first + i], reason);
    if (!value) {
      fail_in_line(name, line, reason + "; a point is 3 numbers");
    }
    point[static_cast<Eigen::Index>(i)] = *value;
  }
  return point;
}

}  // namespace hbar::scene
