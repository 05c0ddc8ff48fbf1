#pragma once

#include <string>

#include "hbar/core/files/csv.h"

namespace hbar::scene {

/// A line of a table with one more cell: eight hexadecimal digits that depend on the text of all
/// others (FNV-1a), so that a line that was changed by accident is found.
///
/// @param line  cells, separated by commas, as csv_cell writes them; no end of line
[[nodiscard]] std::string with_checksum(const std::string& line);

/// Removes the last cell of a row, which is its checksum. An empty one is allowed: a line that was
/// edited by hand.
///
/// @throws InvalidInput that begins `file:line:column:` if it is neither empty nor right
void take_checksum(CsvRow& row, const std::string& file);

}  // namespace hbar::scene
