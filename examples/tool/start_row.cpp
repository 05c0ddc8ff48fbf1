#include "start_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/files/csv.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"
#include "labels.h"

namespace hbar::tool {
namespace {

/// The column of one of two names.
std::size_t find_column(const scene::CsvRow& heading, const std::string& name,
                        const std::string& other, const std::string& file) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < heading.size(); ++i) {
    if (heading[i].text != name && heading[i].text != other) {
      continue;
    }
    if (found) {
      scene::fail_at(heading[i], file, fmt::format("a second column {}", heading[i].text));
    }
    found = i;
  }
  if (!found) {
    throw InvalidInput(fmt::format(
        "{}:{}: there is no column {} (or {}); a start needs every coordinate and its rate", file,
        heading[0].line, name, other));
  }
  return *found;
}

/// The row that a number names.
const scene::CsvRow& find_row(const std::vector<scene::CsvRow>& rows, int number,
                              const std::string& file) {
  const int count = static_cast<int>(rows.size()) - 1;
  const int index = number < 0 ? count + number : number;
  if (index < 0 || index >= count) {
    throw InvalidInput(count == 0
                           ? fmt::format("{}: there is no row below the heading", file)
                           : fmt::format("{}: there is no row {}; they are 0 to {}, or -{} to -1",
                                         file, number, count - 1, count));
  }
  return rows[static_cast<std::size_t>(index) + 1];
}

}  // namespace

std::filesystem::path read_start_row(const std::string& where, const Model& model, Inputs& inputs) {
  std::string file = where;
  int number = -1;
  const std::size_t colon = where.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    std::string reason;
    const auto row = scene::parse_integer(std::string_view(where).substr(colon + 1), reason);
    if (row) {
      file = where.substr(0, colon);
      number = *row;
    } else if (!std::filesystem::exists(where)) {
      throw InvalidInput(fmt::format("--from {}: {}; a row is named as in FILE:10 or FILE:-1",
                                     scene::quotable(where), reason));
    }
  }
  const std::vector<scene::CsvRow> rows = scene::parse_csv(scene::read_text_file(file), file);
  if (rows.empty()) {
    throw InvalidInput(fmt::format("{}: the table is empty", file));
  }
  const scene::CsvRow& row = find_row(rows, number, file);
  if (row.size() != rows[0].size()) {
    scene::fail_at(
        row.back(), file,
        fmt::format("the row has {} cells; the heading has {}", row.size(), rows[0].size()));
  }
  Eigen::Index i = 0;
  for (const std::string& name : coordinate_names(model)) {
    inputs.q0[i] = scene::number_in(row[find_column(rows[0], "q." + name, name, file)], file);
    inputs.qdot0[i] =
        scene::number_in(row[find_column(rows[0], "qdot." + name, "rate." + name, file)], file);
    ++i;
  }
  return file;
}

}  // namespace hbar::tool
