#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hbar::tool {

/// The entries of a list whose separators are blanks, or commas with blanks around them.
///
/// @param reason  set to a clause that says what is wrong, if anything is; else left empty
[[nodiscard]] std::vector<std::string_view> split_entries(std::string_view text,
                                                          std::string& reason);

/// The numbers of such a list.
///
/// @param reason  as split_entries
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::string& reason);

}  // namespace hbar::tool
