#include "hbar/core/base/error.h"

#include <charconv>

namespace hbar::detail {

Piece::Piece(char letter) : number_{letter}, digits_(1) {}

// As a stream in the "C" locale writes them, whatever the global locale is.
Piece::Piece(double number) {
  const auto end =
      std::to_chars(number_, number_ + sizeof number_, number, std::chars_format::general, 6);
  digits_ = static_cast<std::size_t>(end.ptr - number_);
}

Piece::Piece(std::in_place_t, long long number) {
  digits_ = static_cast<std::size_t>(std::to_chars(number_, number_ + sizeof number_, number).ptr -
                                     number_);
}

Piece::Piece(std::in_place_t, unsigned long long number) {
  digits_ = static_cast<std::size_t>(std::to_chars(number_, number_ + sizeof number_, number).ptr -
                                     number_);
}

std::string join(std::initializer_list<Piece> pieces) {
  std::size_t size = 0;
  for (const Piece& piece : pieces) {
    size += piece.text().size();
  }
  std::string all;
  all.reserve(size);
  for (const Piece& piece : pieces) {
    all += piece.text();
  }
  return all;
}

void throw_index(const char* what, long i, long count) {
  throw InvalidInput(count == 0
                         ? concat("there is no ", what, " ", i, ", as there is none at all")
                         : concat("there is no ", what, " ", i, "; they are 0 to ", count - 1));
}

}  // namespace hbar::detail
