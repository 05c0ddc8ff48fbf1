// A mutation for texts with numbers, which libFuzzer calls in place of its own: in one of two
// cases, a number of the text becomes another one. Changing single bytes hardly ever leaves a text
// that is read, and of those that are, hardly any has a number that is hard on arithmetic.

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/files/numbers.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::array<std::string_view, 26> kOddNumbers = {
    "0",      "-0",     "1",      "-1",    "0.5",   "1e-9",   "1e9",        "1e-16",      "1e16",
    "1e-30",  "1e30",   "1e-155", "1e155", "1e200", "1e-200", "1e-300",     "1e300",      "1e308",
    "-1e308", "5e-324", "1e999",  "nan",   "inf",   "2",      "2147483647", "-2147483648"};

struct Part {
  std::size_t begin;
  std::size_t size;
};

std::vector<Part> numbers_of(std::string_view text) {
  constexpr std::string_view kInNumbers = "0123456789+-.eE";
  std::vector<Part> numbers;
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t end = std::min(text.find_first_not_of(kInNumbers, i), text.size());
    const std::string_view run = text.substr(i, end - i);
    if (run.find_first_of("0123456789") != std::string_view::npos) {
      numbers.push_back({i, run.size()});
    }
    i = end + 1;
  }
  return numbers;
}

/// An odd number, or one near the given one.
std::string other_number(std::string_view text, std::minstd_rand& random) {
  std::string reason;
  const auto number = hbar::scene::parse_number(text, reason);
  const auto kind = random() % 5;
  if (!number || kind < 2) {
    return std::string(kOddNumbers[random() % kOddNumbers.size()]);
  }
  if (kind == 2) {
    return hbar::scene::format_number(-*number);
  }
  if (kind == 3) {
    return hbar::scene::format_number(*number + static_cast<double>(random() % 9) - 4.0);
  }
  constexpr std::array kFactors = {1e-6, 1e-3, 0.1, 0.5, 0.999, 1.001, 2.0, 10.0, 1e3, 1e6};
  return hbar::scene::format_number(*number * kFactors[random() % kFactors.size()]);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  std::minstd_rand random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::vector<Part> numbers = numbers_of(text);
  if (numbers.empty() || random() % 2 == 0) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  const Part chosen = numbers[random() % numbers.size()];
  text.replace(chosen.begin, chosen.size,
               other_number(std::string_view(text).substr(chosen.begin, chosen.size), random));
  if (text.size() > max_size) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
