#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hbar {

/// The candidate with the smallest edit distance to `name`; empty if there is no candidate.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& candidates);

/// "…; did you mean 'x'?" or, without a near candidate, "…; known: a, b, c".
[[nodiscard]] std::string unknown_name_hint(std::string_view name,
                                            const std::vector<std::string>& candidates);

}  // namespace hbar
