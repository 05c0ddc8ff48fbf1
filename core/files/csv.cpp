#include "hbar/core/files/csv.h"

#include <algorithm>
#include <optional>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::scene {
namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Reads a text cell by cell and keeps track of its position.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& file) : text_(text), file_(file) {
    if (text_.starts_with("\xef\xbb\xbf")) {
      text_.remove_prefix(3);
    }
  }

  std::vector<CsvRow> rows() {
    std::vector<CsvRow> rows;
    while (at_ < text_.size()) {
      const std::size_t end = line_end();
      if (text_[at_] == '#' || without_blanks(text_.substr(at_, end - at_)).empty()) {
        at_ = end;
      } else {
        if (rows.empty()) {
          separator_ = separator();
        }
        rows.push_back(row());
      }
      leave_line();
    }
    return rows;
  }

 private:
  /// What separates the cells of the row that begins here.
  [[nodiscard]] char separator() const {
    bool quoted = false;
    char found = ',';
    for (const char c : text_.substr(at_)) {
      quoted = quoted != (c == '"');
      if (!quoted && (c == '\n' || c == ',')) {
        return c == ',' ? ',' : found;
      }
      found = !quoted && c == ';' ? ';' : found;
    }
    return found;
  }
  /// Where the current line's text ends: at \n, at \r\n or at the end of the text.
  [[nodiscard]] std::size_t line_end() const {
    const std::size_t found = std::min(text_.find('\n', at_), text_.size());
    return found > at_ && text_[found - 1] == '\r' ? found - 1 : found;
  }
  void leave_line() {
    at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1;
    begin_ = at_;
    ++line_;
  }
  CsvRow row() {
    CsvRow row;
    row.push_back(cell());
    while (at_ < text_.size() && text_[at_] == separator_) {
      ++at_;
      row.push_back(cell());
    }
    return row;
  }
  CsvCell cell() {
    CsvCell cell{.text = {}, .line = line_, .column = static_cast<int>(at_ - begin_) + 1};
    if (at_ < text_.size() && text_[at_] == '"') {
      quoted(cell);
    } else {
      const std::size_t end = std::min(text_.find(separator_, at_), line_end());
      cell.text = without_blanks(text_.substr(at_, end - at_));
      at_ = end;
    }
    return cell;
  }
  void quoted(CsvCell& cell) {
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        if (text_.substr(at_ + 1, 1) != "\"") {
          break;
        }
        ++at_;
      }
      if (text_[at_] == '\n') {
        ++line_;
        begin_ = at_ + 1;
      }
      cell.text += text_[at_];
    }
    if (at_ == text_.size()) {
      fail_at(cell, file_, "a quote is opened here and not closed");
    }
    ++at_;
    if (at_ < line_end() && text_[at_] != separator_) {
      fail_at(cell, file_, "text after a closing quote; a quote within a cell is written twice");
    }
  }

  std::string_view text_;
  const std::string& file_;
  char separator_ = ',';
  std::size_t at_ = 0;
  std::size_t begin_ = 0;  // of the current line
  int line_ = 1;
};

}  // namespace

std::vector<CsvRow> parse_csv(std::string_view text, const std::string& file) {
  return CsvReader(text, file).rows();
}

std::string csv_cell(std::string_view text) {
  const bool plain = text.find_first_of(",;\"\r\n") == std::string_view::npos &&
                     without_blanks(text).size() == text.size() && text.substr(0, 1) != "#" &&
                     !text.starts_with("\xef\xbb\xbf");
  if (plain) {
    return std::string(text);
  }
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') {
      out += c;
    }
  }
  return out + '"';
}

double number_in(const CsvCell& cell, const std::string& file) {
  std::string reason;
  const std::optional<double> number = parse_number(cell.text, reason);
  if (!number) {
    fail_at(cell, file, reason);
  }
  return *number;
}

int integer_in(const CsvCell& cell, const std::string& file) {
  std::string reason;
  const std::optional<int> number = parse_integer(cell.text, reason);
  if (!number) {
    fail_at(cell, file, reason);
  }
  return *number;
}

void fail_at(const CsvCell& cell, const std::string& file, const std::string& reason) {
  throw InvalidInput(concat(file, ':', cell.line, ':', cell.column, ": ", reason));
}

}  // namespace hbar::scene
