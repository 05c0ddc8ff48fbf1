#pragma once

#include <string>
#include <string_view>

/// A target of the fuzzer is one file that defines try_input; entry.cpp calls it.
namespace hbar::fuzz {

/// Reads an input as a file or a command line would be read, and does what a user would do with it.
///
/// May return, or throw an hbar::Error with a message. Everything else is a finding: another
/// exception, a report of a sanitizer, a call of fail(), too much time or memory.
void try_input(std::string_view input);

/// A finding: ends the process.
[[noreturn]] void fail(const std::string& what);

/// A finding unless it holds.
inline void require(bool holds, const std::string& what) {
  if (!holds) {
    fail(what);
  }
}

}  // namespace hbar::fuzz
