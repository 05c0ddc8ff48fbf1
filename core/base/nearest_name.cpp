#include "hbar/core/base/nearest_name.h"

#include <algorithm>
#include <numeric>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto nearest = std::min_element(candidates.begin(), candidates.end(),
                                        [name](const std::string& a, const std::string& b) {
                                          return edit_distance(name, a) < edit_distance(name, b);
                                        });
  return nearest == candidates.end() ? std::string() : *nearest;
}

std::string unknown_name_hint(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  if (nearest.empty()) {
    return "there are none";
  }
  if (edit_distance(name, nearest) <= std::max<std::size_t>(2, name.size() / 3)) {
    return concat("did you mean '", nearest, "'?");
  }
  constexpr std::size_t kListed = 12;
  std::string list = "known: ";
  for (std::size_t i = 0; i < std::min(candidates.size(), kListed); ++i) {
    list += (i == 0 ? "" : ", ") + candidates[i];
  }
  return candidates.size() > kListed ? list + ", …" : list;
}

}  // namespace hbar
