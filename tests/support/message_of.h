#pragma once

#include <string>

namespace hbar::testing {

/// The message of the Failure that a call throws; empty if it throws none.
template <typename Failure, typename Call>
[[nodiscard]] std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return {};
}

}  // namespace hbar::testing
