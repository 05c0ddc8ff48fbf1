#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "tests/support/allocation_counters.h"

/// Counts the allocations of a whole program, Eigen's included. It replaces malloc (with glibc) or,
/// under a sanitizer, operator new alone: include it in one .cpp of an executable, no more; others
/// that read the counters include allocation_counters.h.

#if HBAR_COUNTS_MALLOC
extern "C" std::size_t malloc_usable_size(void* block) noexcept;
#endif

namespace hbar::testing {

inline void* counted_block(void* block) {
  ++allocation_count();
#if HBAR_COUNTS_MALLOC
  count_bytes(block == nullptr ? 0 : static_cast<std::ptrdiff_t>(malloc_usable_size(block)));
#endif
  return block;
}

inline void count_free(void* block) {
#if HBAR_COUNTS_MALLOC
  count_bytes(block == nullptr ? 0 : -static_cast<std::ptrdiff_t>(malloc_usable_size(block)));
#else
  static_cast<void>(block);
#endif
}

}  // namespace hbar::testing

#if HBAR_COUNTS_MALLOC
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
void* malloc(std::size_t size) noexcept {
  return hbar::testing::counted_block(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return hbar::testing::counted_block(__libc_calloc(count, size));
}
void* realloc(void* block, std::size_t size) noexcept {
  hbar::testing::count_free(block);
  return hbar::testing::counted_block(__libc_realloc(block, size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return hbar::testing::counted_block(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return hbar::testing::counted_block(__libc_memalign(alignment, size));
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = hbar::testing::counted_block(__libc_memalign(alignment, size));
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) noexcept {
  hbar::testing::count_free(block);
  __libc_free(block);
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
