#include "entries.h"

#include <fmt/format.h>

#include "hbar/core/files/numbers.h"

namespace hbar::tool {

std::vector<std::string_view> split_entries(std::string_view text, std::string& reason) {
  std::vector<std::string_view> entries;
  if (scene::split_words(text).empty()) {
    return entries;
  }
  const bool single = text.find(',') == std::string_view::npos;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::vector<std::string_view> words = scene::split_words(text.substr(begin, end - begin));
    if (words.empty() && !single) {
      reason = fmt::format("entry {} is missing between commas", entries.size() + 1);
      return {};
    }
    entries.insert(entries.end(), words.begin(), words.end());
    begin = end + 1;
  }
  return entries;
}

std::vector<double> parse_numbers(std::string_view text, std::string& reason) {
  std::vector<double> numbers;
  for (const std::string_view entry : split_entries(text, reason)) {
    const std::optional<double> number = scene::parse_number(entry, reason);
    if (!number) {
      reason = fmt::format("entry {}: {}", numbers.size() + 1, reason);
      return {};
    }
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace hbar::tool
