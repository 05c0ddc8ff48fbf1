#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace hbar {

/// The 64-bit FNV-1a hash of a byte string that arrives in parts. For each byte the update of the
/// state is one-to-one, so that changing one byte always changes the sum. Guards against accidents,
/// not against tampering.
class Checksum {
 public:
  /// Adds bytes.
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      sum_ = (sum_ ^ static_cast<unsigned char>(byte)) * std::uint64_t{0x100000001b3};
    }
  }
  /// Adds the bytes of a number, as they are in memory.
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
    add(std::string_view(bytes.data(), bytes.size()));
  }
  /// The checksum of what was added.
  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325;
};

}  // namespace hbar
