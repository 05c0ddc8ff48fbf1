// Matrix Market files: a square matrix, or a column of numbers.

#include "examples/solver_benchmark/matrix_market.h"

#include <algorithm>
#include <cctype>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

// Larger sizes are slow, and no mistake of the reader.
constexpr std::ptrdiff_t kMostDigits = 4;
constexpr Eigen::Index kVectorRows = 3;

/// Whether the line of sizes, the first that is no comment, may say a large number: by many digits,
/// or by an exponent.
bool is_large(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto words = scene::split_words(line);
    if (words.empty() || words[0][0] == '%') {
      continue;
    }
    std::ptrdiff_t digits = 0;
    return std::any_of(line.begin(), line.end(), [&](char c) {
      digits = kDigits.find(c) == std::string_view::npos ? 0 : digits + 1;
      return digits > kMostDigits || std::isalpha(static_cast<unsigned char>(c)) != 0;
    });
  }
  return false;
}

void try_vector(const ScratchFolder& folder, const std::filesystem::path& file) {
  const Eigen::VectorXd x = solver_benchmark::read_vector(file, kVectorRows);
  require(x.size() == kVectorRows && x.allFinite(), "a vector that is none");
  const auto written = folder.path() / "written.mtx";
  solver_benchmark::write_vector(written, x, "written");
  require(solver_benchmark::read_vector(written, kVectorRows) == x, "a vector is read differently");
}

}  // namespace

void try_input(std::string_view input) {
  static const ScratchFolder kFolder;
  if (is_large(input)) {
    return;
  }
  const auto file = kFolder.put("matrix.mtx", input);
  solvers::SparseMatrix A;
  try {
    A = solver_benchmark::read_matrix(file);
  } catch (const InvalidInput&) {
    return try_vector(kFolder, file);  // no text is both
  }
  const Eigen::Map<const Eigen::VectorXd> values(A.valuePtr(), A.nonZeros());
  require(A.rows() == A.cols() && values.allFinite(), "a matrix that is none");
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    for (auto k = A.outerIndexPtr()[j]; k < A.outerIndexPtr()[j + 1]; ++k) {
      const auto row = A.innerIndexPtr()[k];
      require(row >= 0 && row < A.rows(), "an entry outside the matrix");
      require(k == A.outerIndexPtr()[j] || row > A.innerIndexPtr()[k - 1], "rows do not ascend");
    }
  }
  const auto written = kFolder.path() / "written.mtx";
  solver_benchmark::write_matrix(written, A, "written");
  const solvers::SparseMatrix again = solver_benchmark::read_matrix(written);
  require(again.rows() == A.rows() && (again - A).norm() == 0.0, "a matrix is read differently");
}

}  // namespace hbar::fuzz
