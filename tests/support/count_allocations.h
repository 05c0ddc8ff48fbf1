#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

/// Counts the allocations of a whole program, Eigen's included. It replaces malloc (with glibc) or,
/// under a sanitizer, operator new alone: include it in one .cpp of an executable, no more.

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

inline std::atomic<std::size_t>& allocation_count() {
  static std::atomic<std::size_t> count = 0;
  return count;
}

/// Number of allocations that a call makes.
template <typename Call>
[[nodiscard]] std::size_t allocations_of(const Call& call) {
  const std::size_t before = allocation_count();
  call();
  return allocation_count() - before;
}

}  // namespace hbar::testing

#if HBAR_COUNTS_MALLOC
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* malloc(std::size_t size) noexcept {
  ++hbar::testing::allocation_count();
  return __libc_malloc(size);
}
void* realloc(void* block, std::size_t size) noexcept {
  ++hbar::testing::allocation_count();
  return __libc_realloc(block, size);
}
}
#else
#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 inlines one of the two below and then warns that they do not match.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t size) {
  ++hbar::testing::allocation_count();
  if (void* block = std::malloc(size > 0 ? size : 1)) {
    return block;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++hbar::testing::allocation_count();
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
#endif
