#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hbar::scene {

/// A cell of a table and where it stands.
struct CsvCell {
  std::string text;  ///< without quotes, and without blanks around unquoted text
  int line = 0;      ///< from 1
  int column = 0;    ///< of its first character, from 1
};

using CsvRow = std::vector<CsvCell>;

/// The rows of a table of comma-separated values (RFC 4180): a cell in quotes may hold commas, line
/// ends and doubled quotes. Empty lines and lines that begin with # are left out, as is a byte
/// order mark. Where the first row has no comma outside quotes but semicolons, those separate, as
/// in tables from spreadsheets of many countries; numbers have a decimal point all the same.
///
/// @param text  the file's bytes
/// @param file  its name for messages
/// @throws InvalidInput that begins `file:line:column:` for a quote that is not closed, or text
///   after one
[[nodiscard]] std::vector<CsvRow> parse_csv(std::string_view text, const std::string& file);

/// A text as a cell, quoted if it could be misread otherwise.
[[nodiscard]] std::string csv_cell(std::string_view text);

/// A cell's number.
///
/// @throws InvalidInput that begins `file:line:column:` if it is not one finite number
[[nodiscard]] double number_in(const CsvCell& cell, const std::string& file);

/// A cell's whole number; as number_in.
[[nodiscard]] int integer_in(const CsvCell& cell, const std::string& file);

/// @throws InvalidInput always: `file:line:column: reason`
[[noreturn]] void fail_at(const CsvCell& cell, const std::string& file, const std::string& reason);

}  // namespace hbar::scene
