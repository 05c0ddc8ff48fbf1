#pragma once

#include <atomic>

#include "hbar/core/base/error.h"

namespace hbar {

/// Whether a stop flag is set: what runs should end soon. A null pointer is a flag never set.
[[nodiscard]] inline bool is_set(const std::atomic<bool>* stop) {
  return stop != nullptr && stop->load(std::memory_order_relaxed);
}

/// @param where  what runs and how far it has got, in parts as for concat
/// @throws Interrupted if the flag is set: "WHERE"
template <typename... Parts>
void require_running(const std::atomic<bool>* stop, const Parts&... where) {
  if (is_set(stop)) {
    throw Interrupted(concat(where...));
  }
}

}  // namespace hbar
