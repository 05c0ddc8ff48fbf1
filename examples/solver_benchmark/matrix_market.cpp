#include "matrix_market.h"

#include <cholmod.h>
#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

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

/// CHOLMOD's settings and workspace.
class Common {
 public:
  Common() {
    cholmod_start(&common_);
    common_.print = 0;
  }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  ~Common() { cholmod_finish(&common_); }

  [[nodiscard]] cholmod_common* get() { return &common_; }
  [[nodiscard]] bool out_of_memory() const { return common_.status == CHOLMOD_OUT_OF_MEMORY; }

 private:
  cholmod_common common_ = {};
};

struct FreeSparse {
  cholmod_common* common;
  void operator()(cholmod_sparse* A) const { cholmod_free_sparse(&A, common); }
};
struct FreeDense {
  cholmod_common* common;
  void operator()(cholmod_dense* X) const { cholmod_free_dense(&X, common); }
};
struct CloseFile {
  void operator()(FILE* file) const { ::fclose(file); }
};
using SparsePointer = std::unique_ptr<cholmod_sparse, FreeSparse>;
using DensePointer = std::unique_ptr<cholmod_dense, FreeDense>;
using FilePointer = std::unique_ptr<FILE, CloseFile>;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& found,
                         const char* allowed) {
  throw InvalidInput(concat(file.string(), ": ", found, "; ", allowed));
}

/// The words of the first line in small letters, which say what kind of matrix follows.
std::vector<std::string> banner(const std::filesystem::path& file, const std::string& text,
                                const char* allowed) {
  std::string line = text.substr(0, text.find('\n'));
  std::transform(line.begin(), line.end(), line.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  if (words.size() != 5 || words[0] != "%%matrixmarket" || words[1] != "matrix") {
    refuse(file, concat("the first line is \"", scene::quotable(line), "\""), allowed);
  }
  return words;
}

void require(const std::filesystem::path& file, const std::string& word,
             const std::vector<std::string>& words, const char* allowed) {
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    refuse(file, concat("the matrix is ", scene::quotable(word)), allowed);
  }
}

/// Refuses what CHOLMOD does not notice: sizes that are no whole numbers (it returns a wild pointer
/// for negative ones), fewer entries than promised (it keeps their memory), and lines that it would
/// read in part.
///
/// @param count  of sizes: 3 for a matrix (the last is that of its entries), 2 for a dense one
void check_lines(const std::filesystem::path& file, std::string_view text, std::size_t count,
                 const char* allowed) {
  constexpr std::size_t kLongestLine = 1000;
  std::vector<int> sizes;
  std::int64_t entries = 0;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.size() > kLongestLine) {
      refuse(file, concat("line ", number, " has more than ", kLongestLine, " characters"),
             allowed);
    }
    if (line.find('\0') != std::string_view::npos) {
      refuse(file, concat("line ", number, " has a zero byte"), allowed);
    }
    if (line.starts_with('%') || line.find_first_not_of(" \t\r\v\f") == std::string_view::npos) {
      continue;
    }
    if (!sizes.empty()) {
      ++entries;
      continue;
    }
    for (const std::string_view word : scene::split_words(line)) {
      std::string reason;
      sizes.push_back(scene::parse_integer(word, reason).value_or(-1));
    }
    if (sizes.size() != count || *std::min_element(sizes.begin(), sizes.end()) < 0) {
      refuse(file,
             concat("line ", number, " is \"", scene::quotable(line), "\" where ", count,
                    " sizes belong"),
             allowed);
    }
  }
  if (sizes.empty()) {
    refuse(file, "there is no line of sizes", allowed);
  }
  const std::int64_t promised = count == 3 ? sizes[2] : std::int64_t{sizes[0]} * sizes[1];
  if (entries < promised) {
    refuse(file, concat("there are ", entries, " lines of entries; its sizes promise ", promised),
           allowed);
  }
}

/// A text as CHOLMOD reads it: a FILE over its bytes.
FilePointer reader(std::string& text) {
  FilePointer stream(::fmemopen(text.data(), text.size(), "r"));
  if (stream == nullptr) {
    throw std::bad_alloc();
  }
  return stream;
}

/// What `write` writes into a FILE.
template <typename Write>
std::string written(const Write& write) {
  char* data = nullptr;
  std::size_t size = 0;
  FilePointer stream(::open_memstream(&data, &size));
  const bool done = stream != nullptr && write(stream.get()) >= 0;
  stream.reset();
  const std::unique_ptr<char, void (*)(void*)> owner(data, ::free);
  if (!done || data == nullptr) {
    throw std::bad_alloc();  // a stream in memory fails for nothing else
  }
  return {data, size};
}

void check_finite(const std::filesystem::path& file, const double* values, std::size_t count,
                  const char* allowed) {
  // CHOLMOD writes and reads infinities as numbers beyond 1e308.
  const auto huge = [](double value) { return !(std::abs(value) < 1e308); };
  if (std::any_of(values, values + count, huge)) {
    refuse(file, "an entry is not a finite number", allowed);
  }
}

/// CHOLMOD writes a matrix of ones as a pattern, and gives that other entries when it reads it if
/// it is symmetric: the same with its ones.
std::string with_ones(const std::string& text) {
  const std::string pattern = " pattern ";
  const std::size_t at = text.find(pattern);
  if (at >= text.find('\n')) {
    return text;
  }
  std::istringstream stream(text);
  std::string out;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;  // the head line and that of sizes come before the entries
    out += line_number == 1 ? line.replace(at, pattern.size(), " integer ") : line;
    out += line_number > 2 ? " 1\n" : "\n";
  }
  return out;
}

/// With CHOLMOD's head line, the comment follows.
std::string with_comment(std::string text, const std::string& comment) {
  std::string lines;
  std::istringstream stream(comment);
  for (std::string line; std::getline(stream, line);) {
    lines += "% " + line + '\n';
  }
  return text.insert(text.find('\n') + 1, lines);
}

}  // namespace

bool has_matrix_market() { return true; }

solvers::SparseMatrix read_matrix(const std::filesystem::path& file) {
  std::string text = scene::read_text_file(file);
  const std::vector<std::string> words = banner(file, text, kMatrixKinds);
  require(file, words[2], {"coordinate"}, kMatrixKinds);
  require(file, words[3], {"real", "integer", "pattern"}, kMatrixKinds);
  require(file, words[4], {"general", "symmetric", "skew-symmetric"}, kMatrixKinds);
  check_lines(file, text, 3, kMatrixKinds);
  Common common;
  SparsePointer A(cholmod_read_sparse(reader(text).get(), common.get()), {common.get()});
  if (A != nullptr && A->stype != 0) {
    A.reset(cholmod_copy(A.get(), 0, 1, common.get()));
  }
  if (common.out_of_memory()) {
    throw std::bad_alloc();
  }
  if (A == nullptr || A->xtype != CHOLMOD_REAL) {
    refuse(file, "sizes, indices or numbers are not as they should be", kMatrixKinds);
  }
  if (A->nrow != A->ncol || A->nrow == 0) {
    refuse(file, concat("the matrix has ", A->nrow, " rows and ", A->ncol, " columns"),
           kMatrixKinds);
  }
  cholmod_sort(A.get(), common.get());
  const auto* outer = static_cast<const int*>(A->p);
  const auto* values = static_cast<const double*>(A->x);
  const auto count = static_cast<std::size_t>(outer[A->ncol]);
  if (count == 0) {
    refuse(file, "the matrix has no entry", kMatrixKinds);
  }
  check_finite(file, values, count, kMatrixKinds);
  const auto n = static_cast<Eigen::Index>(A->nrow);
  return Eigen::Map<const solvers::SparseMatrix>(n, n, static_cast<Eigen::Index>(count), outer,
                                                 static_cast<const int*>(A->i), values);
}

Eigen::VectorXd read_vector(const std::filesystem::path& file, Eigen::Index rows) {
  std::string text = scene::read_text_file(file);
  const std::vector<std::string> words = banner(file, text, kVectorKinds);
  require(file, words[2], {"array"}, kVectorKinds);
  require(file, words[3], {"real", "integer"}, kVectorKinds);
  require(file, words[4], {"general"}, kVectorKinds);
  check_lines(file, text, 2, kVectorKinds);
  Common common;
  const DensePointer x(cholmod_read_dense(reader(text).get(), common.get()), {common.get()});
  if (common.out_of_memory()) {
    throw std::bad_alloc();
  }
  if (x == nullptr || x->xtype != CHOLMOD_REAL) {
    refuse(file, "sizes or numbers are not as they should be", kVectorKinds);
  }
  if (static_cast<Eigen::Index>(x->nrow) != rows || x->ncol != 1) {
    refuse(file,
           concat("there are ", x->nrow, " rows and ", x->ncol, " columns where ", rows,
                  " rows and 1 column belong"),
           kVectorKinds);
  }
  const auto* values = static_cast<const double*>(x->x);
  check_finite(file, values, x->nzmax, kVectorKinds);
  return Eigen::Map<const Eigen::VectorXd>(values, rows);
}

void write_matrix(const std::filesystem::path& file, const solvers::SparseMatrix& A,
                  const std::string& comment) {
  solvers::SparseMatrix copy = A;
  copy.makeCompressed();
  Common common;
  cholmod_sparse view = {};
  view.nrow = static_cast<std::size_t>(copy.rows());
  view.ncol = static_cast<std::size_t>(copy.cols());
  view.nzmax = static_cast<std::size_t>(copy.nonZeros());
  view.p = copy.outerIndexPtr();
  view.i = copy.innerIndexPtr();
  view.x = copy.valuePtr();
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  const std::string text = written([&](FILE* stream) {
    return cholmod_write_sparse(stream, &view, nullptr, nullptr, common.get());
  });
  scene::write_result_file(file, with_comment(with_ones(text), comment));
}

void write_vector(const std::filesystem::path& file, const Eigen::VectorXd& x,
                  const std::string& comment) {
  Eigen::VectorXd copy = x;
  Common common;
  cholmod_dense view = {};
  view.nrow = static_cast<std::size_t>(copy.size());
  view.ncol = 1;
  view.nzmax = view.nrow;
  view.d = view.nrow;
  view.x = copy.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  const std::string text = written(
      [&](FILE* stream) { return cholmod_write_dense(stream, &view, nullptr, common.get()); });
  scene::write_result_file(file, with_comment(text, comment));
}

}  // namespace hbar::solver_benchmark
