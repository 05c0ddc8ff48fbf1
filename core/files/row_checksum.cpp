#include "hbar/core/files/row_checksum.h"

#include <array>
#include <cstdint>
#include <cstdio>

#include "hbar/core/base/checksum.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::scene {
namespace {

std::string checksum_of(const CsvRow& row) {
  Checksum sum;
  for (const CsvCell& cell : row) {
    sum.add(cell.text);
    sum.add(std::string_view("\0", 1));  // which no cell has
  }
  const auto folded = static_cast<std::uint32_t>(sum.value() ^ (sum.value() >> 32));
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(folded));
  return text.data();
}

}  // namespace

std::string with_checksum(const std::string& line) {
  return line + ',' + checksum_of(parse_csv(line, "line").at(0));
}

void take_checksum(CsvRow& row, const std::string& file) {
  const CsvCell found = row.back();
  row.pop_back();
  const std::string right = checksum_of(row);
  if (!found.text.empty() && found.text != right) {
    fail_at(found, file,
            concat("this line was changed or damaged after it was written: its checksum is \"",
                   quotable(found.text), "\" and not ", right,
                   "; restore it, or empty this cell to take the line as it is"));
  }
}

}  // namespace hbar::scene
