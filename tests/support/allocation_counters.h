#pragma once

#include <atomic>
#include <cstddef>

/// What count_allocations.h counts; it must be included in another .cpp of the executable.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HBAR_COUNTS_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HBAR_COUNTS_MALLOC 0
#endif
#endif
#if !defined(HBAR_COUNTS_MALLOC)
#if defined(__GLIBC__)
#define HBAR_COUNTS_MALLOC 1
#else
#define HBAR_COUNTS_MALLOC 0
#endif
#endif

namespace hbar::testing {

/// Whether bytes are counted, not only allocations.
inline constexpr bool kCountsBytes = HBAR_COUNTS_MALLOC != 0;

inline std::atomic<std::size_t>& allocation_count() {
  static std::atomic<std::size_t> count = 0;
  return count;
}
/// Bytes held at present, and the most that were held since it was last set.
inline std::atomic<std::ptrdiff_t>& bytes_held() {
  static std::atomic<std::ptrdiff_t> bytes = 0;
  return bytes;
}
inline std::atomic<std::ptrdiff_t>& most_bytes_held() {
  static std::atomic<std::ptrdiff_t> bytes = 0;
  return bytes;
}

inline void count_bytes(std::ptrdiff_t change) {
  const std::ptrdiff_t held = bytes_held() += change;
  if (held > most_bytes_held()) {
    most_bytes_held() = held;
  }
}

/// Number of allocations that a call makes.
template <typename Call>
[[nodiscard]] std::size_t allocations_of(const Call& call) {
  const std::size_t before = allocation_count();
  call();
  return allocation_count() - before;
}

/// The most bytes that a call holds at once beyond those that were held before, in one thread.
template <typename Call>
[[nodiscard]] double peak_bytes_of(const Call& call) {
  const std::ptrdiff_t before = bytes_held();
  most_bytes_held() = before;
  call();
  return static_cast<double>(most_bytes_held() - before);
}

}  // namespace hbar::testing
