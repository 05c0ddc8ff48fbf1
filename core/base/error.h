#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

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

/// A computation ended before its result was complete because its caller set the stop flag
/// (stop_flag.h). The message says what ended and how far it had got.
class Interrupted : public Error {
 public:
  using Error::Error;
};

namespace detail {

/// What concat puts together: text, or a number as `operator<<` writes it. Borrows the text.
class Piece {
 public:
  Piece(std::string_view text) : text_(text) {}    // NOLINT: pieces are written as what they are
  Piece(const std::string& text) : text_(text) {}  // NOLINT
  Piece(const char* text) : text_(text) {}         // NOLINT
  Piece(char letter);                              // NOLINT
  Piece(double number);                            // NOLINT
  template <std::integral Integer>
  Piece(Integer number) : Piece(std::in_place, number) {}  // NOLINT

  [[nodiscard]] std::string_view text() const {
    return digits_ > 0 ? std::string_view(number_, digits_) : text_;
  }

 private:
  Piece(std::in_place_t, long long number);
  Piece(std::in_place_t, unsigned long long number);
  template <std::integral Integer>
  Piece(std::in_place_t tag, Integer number)
      : Piece(tag, static_cast<std::conditional_t<std::is_signed_v<Integer>, long long,
                                                  unsigned long long>>(number)) {}

  std::string_view text_ = {};
  char number_[32];
  std::size_t digits_ = 0;
};

[[nodiscard]] std::string join(std::initializer_list<Piece> pieces);
[[noreturn]] void throw_index(const char* what, long i, long count);

}  // namespace detail

/// All arguments in one string, each written as by `operator<<`.
template <typename... Parts>
[[nodiscard]] std::string concat(const Parts&... parts) {
  return detail::join({detail::Piece(parts)...});
}

/// @param given  a function or a pointer
/// @throws InvalidInput if it is empty: "WHERE: there is no WHAT"
template <typename Given>
void require_given(std::string_view where, std::string_view what, const Given& given) {
  if (!given) {
    throw InvalidInput(concat(where, ": there is no ", what, " (it is empty or null)"));
  }
}

/// @param what  "link", "parameter", …
/// @throws InvalidInput if i is not in 0 … count − 1
inline void require_index(const char* what, long i, long count) {
  if (i < 0 || i >= count) {
    detail::throw_index(what, i, count);
  }
}

/// The entries of a range, as concat writes them, with blanks between.
template <typename Range>
[[nodiscard]] std::string listed(const Range& entries) {
  std::string all;
  for (const auto& entry : entries) {
    all += all.empty() ? concat(entry) : concat(' ', entry);
  }
  return all;
}

}  // namespace hbar
