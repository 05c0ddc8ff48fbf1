#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace hbar {

/// Base of everything hbar throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A caller's mistake: an argument or a file with content that is not allowed. The message says
/// where, what was found and what is allowed; for a scene it begins with `file:line:`.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file could not be read or written. The message names the file and the system's reason.
class IoError : public Error {
 public:
  using Error::Error;
};

/// A numerical failure: a trajectory, a gradient or a linear solution that would not be right. The
/// message says where, how far it got and what to try.
class NumericalFailure : public Error {
 public:
  using Error::Error;
};

/// All arguments in one string, each written by `operator<<`.
template <typename... Parts>
[[nodiscard]] std::string concat(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

}  // namespace hbar
