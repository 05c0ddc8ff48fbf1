#pragma once

#include <memory>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {

/// A std::unique_ptr that says who was moved from instead of leading nowhere: what classes keep
/// their workspace in.
template <typename T>
class Owned {
 public:
  /// @param owner  the class, for messages; a literal
  Owned(const char* owner, std::unique_ptr<T> held) : owner_(owner), held_(std::move(held)) {}

  /// @throws InvalidInput if the owner was moved from
  [[nodiscard]] T& operator*() const {
    if (held_ == nullptr) {
      throw InvalidInput(concat(owner_, ": this object was moved from, and is empty"));
    }
    return *held_;
  }
  [[nodiscard]] T* operator->() const { return &**this; }

 private:
  const char* owner_;
  std::unique_ptr<T> held_;
};

}  // namespace hbar
