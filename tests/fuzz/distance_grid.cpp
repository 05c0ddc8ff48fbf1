// The bytes of a cached distance grid, and the same bytes as words that a person can write.

#include "hbar/core/geometry/distance_grid.h"

#include <array>
#include <bit>
#include <cmath>

#include "hbar/core/base/checksum.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

constexpr int kMostRepetitions = 4096;

template <typename Number>
void append(std::string& bytes, Number number) {
  const auto part = std::bit_cast<std::array<char, sizeof number>>(number);
  bytes.append(part.data(), part.size());
}

/// The bytes that words stand for: `i4` is an integer, `0.5` a number, `nan` and `inf` those,
/// `216*0.5` many, `sum` the checksum of all before it, anything else its own letters.
std::string bytes_of(std::string_view text) {
  std::string bytes;
  for (std::string_view word : scene::split_words(text)) {
    std::string reason;
    int times = 1;
    if (const std::size_t star = word.find('*'); star != std::string_view::npos) {
      times = scene::parse_integer(word.substr(0, star), reason).value_or(0);
      word.remove_prefix(star + 1);
    }
    const auto number = scene::parse_number(word, reason);
    const auto integer =
        word.starts_with('i') ? scene::parse_integer(word.substr(1), reason) : std::optional<int>();
    for (int i = 0; i < std::min(times, kMostRepetitions); ++i) {
      if (integer) {
        append(bytes, static_cast<std::int64_t>(*integer));
      } else if (number || word == "nan" || word == "inf") {
        append(bytes, number ? *number : word == "nan" ? std::nan("") : HUGE_VAL);
      } else if (word == "sum") {
        Checksum sum;
        sum.add(std::string_view(bytes));
        append(bytes, sum.value());
      } else {
        bytes += word;
      }
    }
  }
  return bytes;
}

void try_bytes(std::string_view bytes) {
  const DistanceGrid grid(bytes);
  require(grid.bytes() == bytes, "a grid is not restored");
  const GridNodes& nodes = grid.nodes();
  for (const double share : {-0.5, 0.0, 0.4, 1.0, 1.5}) {
    const Eigen::Vector3d x = nodes.origin + share * (nodes.last() - nodes.origin);
    const DistanceField::Sample sample = grid.sample(x);
    require(std::isfinite(sample.distance) && sample.gradient.allFinite() &&
                sample.hessian.allFinite() && std::isfinite(grid.lower_bound(x)) &&
                grid.hessian_slope(x, {1.0, 0.0, 0.0}).allFinite(),
            "a distance that is not finite");
  }
}

}  // namespace

void try_input(std::string_view input) {
  try {
    try_bytes(input);
  } catch (const InvalidInput&) {
    try_bytes(bytes_of(input));
  }
}

}  // namespace hbar::fuzz
