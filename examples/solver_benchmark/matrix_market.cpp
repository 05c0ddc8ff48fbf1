#include "matrix_market.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

#include "gzip_file.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/result_file.h"
#include "hbar/core/files/text_file.h"

namespace hbar::solver_benchmark {
namespace {

constexpr const char* kMatrixKinds =
    "allowed: a square matrix after \"%%MatrixMarket matrix coordinate\", of kind real, integer or "
    "pattern, general, symmetric or skew-symmetric";
constexpr const char* kVectorKinds =
    "allowed: one column after \"%%MatrixMarket matrix array\", of kind real or integer, general";

using Words = std::vector<std::string_view>;

/// The lines of a file after its head line, without comments and empty ones.
class Lines {
 public:
  Lines(const std::filesystem::path& file, const char* allowed)
      : name_(file.string()),
        allowed_(allowed),
        text_(file.extension() == ".gz" ? read_gzip_file(file) : scene::read_text_file(file)),
        left_(text_) {
    if (left_.starts_with("\xef\xbb\xbf")) {  // byte order mark
      left_.remove_prefix(3);
    }
    read_head();
  }

  /// The words of the head line in small letters: %%matrixmarket matrix, then what kind it is.
  [[nodiscard]] const std::vector<std::string>& head() const { return head_; }

  /// Refuses a word of the head line that is none of these.
  void require_head(std::size_t word, const Words& words) const {
    if (std::find(words.begin(), words.end(), head_[word]) == words.end()) {
      throw InvalidInput(
          concat(name_, ": the matrix is ", scene::quotable(head_[word]), "; ", allowed_));
    }
  }

  /// Moves to the next line; false at the end.
  bool next() {
    while (!left_.empty()) {
      take();
      words_ = scene::split_words(line_);
      if (!line_.starts_with('%') && !words_.empty()) {
        return true;
      }
    }
    return false;
  }

  /// Words of the line.
  [[nodiscard]] const Words& words() const { return words_; }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(concat(name_, ":", std::max(1, number_), ": ", what, "; ", allowed_));
  }

  /// A whole number of the line, from `least` to `most`.
  [[nodiscard]] int integer(std::size_t word, const char* what, int least, int most) const {
    std::string reason;
    const auto value = scene::parse_integer(words_[word], reason);
    if (!value || *value < least || *value > most) {
      refuse(concat(what, " is ", scene::quotable(words_[word]), "; it must be from ", least,
                    " to ", most));
    }
    return *value;
  }

  [[nodiscard]] double number(std::size_t word) const {
    std::string reason;
    const auto value = scene::parse_number(words_[word], reason);
    if (!value) {
      refuse(reason);
    }
    return *value;
  }

  /// Reads the line of sizes, which are counts.
  template <std::size_t kCount>
  std::array<int, kCount> sizes() {
    std::array<int, kCount> out;
    if (!next()) {
      refuse("there is no line of sizes");
    }
    if (words_.size() != kCount) {
      refuse(concat("\"", scene::quotable(line_), "\" stands where ", kCount, " sizes belong"));
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      out[i] = integer(i, "a size", 0, std::numeric_limits<int>::max());
    }
    return out;
  }

  /// Calls `entry()` at each of the lines that follow.
  ///
  /// @param count  how many there must be
  /// @param width  words of each
  template <typename Entry>
  void entries(std::int64_t count, std::size_t width, const Entry& entry) {
    std::int64_t found = 0;
    while (next()) {
      if (++found > count) {
        refuse(concat("the sizes promise ", count, " entries; this is one more"));
      }
      if (words_.size() != width) {
        refuse(concat("\"", scene::quotable(line_), "\" has ", words_.size(),
                      " words; an entry has ", width));
      }
      entry();
    }
    if (found < count) {
      refuse(concat("the file ends after ", found, " entries; its sizes promise ", count));
    }
  }

 private:
  void take() {
    line_ = left_.substr(0, left_.find('\n'));
    left_.remove_prefix(std::min(line_.size() + 1, left_.size()));
    ++number_;
  }

  void read_head() {
    take();
    for (const std::string_view word : scene::split_words(line_)) {
      head_.emplace_back(word);
      for (char& c : head_.back()) {
        c = 'A' <= c && c <= 'Z' ? static_cast<char>(c + 32) : c;
      }
    }
    if (head_.size() != 5 || head_[0] != "%%matrixmarket" || head_[1] != "matrix") {
      refuse(concat("the first line is \"", scene::quotable(line_), "\""));
    }
  }

  std::string name_;
  const char* allowed_;
  std::string text_;
  std::string_view left_;
  std::string_view line_;
  int number_ = 0;
  std::vector<std::string> head_;
  Words words_;
};

/// Of a file that holds one triangle, which may be either.
class Triangle {
 public:
  void add(const Lines& lines, int row, int column) {
    if (row == column) {
      return;
    }
    const int side = row > column ? 1 : -1;
    if (side_ == -side) {
      lines.refuse(concat("entry (", row, ", ", column, ") is ", side > 0 ? "below" : "above",
                          " the diagonal, earlier ones are on its other side; of such a matrix a "
                          "file has one triangle"));
    }
    side_ = side;
  }

 private:
  int side_ = 0;
};

bool is_symmetric(const solvers::SparseMatrix& A) {
  const solvers::SparseMatrix transposed = A.transpose();
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    solvers::SparseMatrix::InnerIterator a(A, j);
    solvers::SparseMatrix::InnerIterator b(transposed, j);
    for (; a && b; ++a, ++b) {
      if (a.row() != b.row() || a.value() != b.value()) {
        return false;
      }
    }
    if (a || b) {
      return false;
    }
  }
  return true;
}

/// The head line, and the comment.
std::string head(const char* kind, const std::string& comment) {
  std::string out = concat("%%MatrixMarket matrix ", kind, '\n');
  std::istringstream stream(comment);
  for (std::string line; std::getline(stream, line);) {
    out += "% " + line + '\n';
  }
  return out;
}

}  // namespace

solvers::SparseMatrix read_matrix(const std::filesystem::path& file) {
  Lines lines(file, kMatrixKinds);
  lines.require_head(2, {"coordinate"});
  lines.require_head(3, {"real", "integer", "pattern"});
  lines.require_head(4, {"general", "symmetric", "skew-symmetric"});
  const bool is_pattern = lines.head()[3] == "pattern";
  const bool is_general = lines.head()[4] == "general";
  const double mirrored = lines.head()[4] == "symmetric" ? 1.0 : -1.0;
  const auto [rows, columns, count] = lines.sizes<3>();
  if (rows != columns || rows == 0) {
    lines.refuse(concat("the matrix has ", rows, " rows and ", columns, " columns"));
  }
  if (count == 0) {
    lines.refuse("the matrix has no entry");
  }
  std::vector<Eigen::Triplet<double>> entries;
  Triangle triangle;
  lines.entries(count, is_pattern ? 2 : 3, [&, n = rows] {
    const int row = lines.integer(0, "a row", 1, n);
    const int column = lines.integer(1, "a column", 1, n);
    const double value = is_pattern ? 1.0 : lines.number(2);
    entries.emplace_back(row - 1, column - 1, value);
    if (is_general) {
      return;
    }
    triangle.add(lines, row, column);
    if (row != column) {
      entries.emplace_back(column - 1, row - 1, mirrored * value);
    } else if (mirrored < 0.0 && value != 0.0) {
      lines.refuse(concat("entry (", row, ", ", row, ") of a skew-symmetric matrix is ", value));
    }
  });
  solvers::SparseMatrix A(rows, rows);
  A.setFromTriplets(entries.begin(), entries.end());
  const Eigen::Map<const Eigen::VectorXd> values(A.valuePtr(), A.nonZeros());
  if (!values.allFinite()) {
    lines.refuse("the entries of one place add up to more than a double holds");
  }
  return A;
}

Eigen::VectorXd read_vector(const std::filesystem::path& file, Eigen::Index rows) {
  Lines lines(file, kVectorKinds);
  lines.require_head(2, {"array"});
  lines.require_head(3, {"real", "integer"});
  lines.require_head(4, {"general"});
  const auto [found, columns] = lines.sizes<2>();
  if (found != rows || columns != 1) {
    lines.refuse(concat("there are ", found, " rows and ", columns, " columns where ", rows,
                        " rows and 1 column belong"));
  }
  Eigen::VectorXd out(rows);
  Eigen::Index row = 0;
  lines.entries(rows, 1, [&] { out[row++] = lines.number(0); });
  return out;
}

void write_matrix(const std::filesystem::path& file, const solvers::SparseMatrix& A,
                  const std::string& comment) {
  const bool symmetric = is_symmetric(A);
  std::string entries;
  std::int64_t count = 0;
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      if (symmetric && entry.row() < j) {
        continue;
      }
      entries +=
          concat(entry.row() + 1, ' ', j + 1, ' ', scene::format_number(entry.value()), '\n');
      ++count;
    }
  }
  const char* kind = symmetric ? "coordinate real symmetric" : "coordinate real general";
  scene::write_result_file(
      file, head(kind, comment) + concat(A.rows(), ' ', A.cols(), ' ', count, '\n') + entries);
}

void write_vector(const std::filesystem::path& file, const Eigen::VectorXd& x,
                  const std::string& comment) {
  std::string text = head("array real general", comment) + concat(x.size(), " 1\n");
  for (const double value : x) {
    text += scene::format_number(value) + '\n';
  }
  scene::write_result_file(file, text);
}

}  // namespace hbar::solver_benchmark
