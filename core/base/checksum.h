#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace hbar {

/// The 64-bit FNV-1a hash of a string of bytes that comes in parts. Every byte acts on the state
/// one to one, so that a changed byte always changes the sum. It guards against accidents, not
/// against people.
class Checksum {
 public:
  /// Takes bytes in.
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      sum_ = (sum_ ^ static_cast<unsigned char>(byte)) * std::uint64_t{0x100000001b3};
    }
  }
  /// Takes in the bytes of a number, as they are in memory.
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
    add(std::string_view(bytes.data(), bytes.size()));
  }
  /// The sum of what came in.
  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325;
};

}  // namespace hbar
