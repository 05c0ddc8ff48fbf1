#include "hbar/solvers/linear/solver_choice.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "hbar/solvers/linear/band.h"
#include "hbar/solvers/linear/solver_catalogue.h"

namespace hbar::solvers {
namespace {

/// What choose_solver decides by.
struct Shape {
  double entries_per_row = 0.0;
  double band_per_entry = 0.0;       ///< entries of the band, zeros included, for one of the matrix
  double band_places = 0.0;          ///< all of these
  bool is_block_triangular = false;  ///< block lower triangular in options.block_sizes
  int largest_block = 1;             ///< of options.block_sizes
};

Shape shape_of(const SolverOptions& options, const SparseMatrix& A) {
  std::vector<int> begin_of_row;  // of the block that a row is in
  for (const int size : options.block_sizes) {
    const int begin = static_cast<int>(begin_of_row.size());
    begin_of_row.insert(begin_of_row.end(), static_cast<std::size_t>(std::max(size, 0)), begin);
  }
  Shape shape;
  for (const int size : options.block_sizes) {
    shape.largest_block = std::max(shape.largest_block, size);
  }
  shape.is_block_triangular =
      !begin_of_row.empty() && static_cast<Eigen::Index>(begin_of_row.size()) == A.rows();
  for (int j = 0; shape.is_block_triangular && j < A.cols(); ++j) {
    // Rows ascend within a column.
    const int begin = A.outerIndexPtr()[j];
    shape.is_block_triangular =
        begin == A.outerIndexPtr()[j + 1] ||
        A.innerIndexPtr()[begin] >= begin_of_row[static_cast<std::size_t>(j)];
  }
  const double rows = static_cast<double>(std::max<Eigen::Index>(A.rows(), 1));
  const double entries = static_cast<double>(std::max<Eigen::Index>(A.nonZeros(), 1));
  shape.entries_per_row = entries / rows;
  shape.band_places = rows * (2.0 * band_of(A).width() + 1.0);
  shape.band_per_entry = shape.band_places / entries;
  return shape;
}

// Measured on the matrices of `hbar corpus`, with the BLAS of a fresh system (doc/solvers.md).
// Above this many entries per row, dense blocks are faster than one column at a time.
constexpr double kManyEntries = 48.0;
// Up to this many places of the band per entry, a band of dense blocks pays off despite its zeros.
constexpr double kNarrowBand = 3.0;
// Up to these sizes, a scalar band is faster than one of blocks: for H̄, for definite matrices.
constexpr int kTinyBlock = 2;
constexpr int kSmallBlock = 5;

/// Rules for choose_solver: the first that applies and whose solver this build has decides.
std::vector<std::pair<bool, SolverChoice>> rules(const SolverOptions& options, const Shape& shape) {
  using enum Ordering;
  const bool definite = options.structure == Structure::kDefinite;
  const bool quasi_definite = options.structure == Structure::kQuasiDefinite;
  const bool triangular = shape.is_block_triangular && !definite && !quasi_definite;
  const bool dense = shape.entries_per_row > kManyEntries;
  // Factors of a band take up to twice its places.
  const bool narrow =
      shape.band_per_entry <= kNarrowBand && 16.0 * shape.band_places <= kMaxBandBytes;
  return {
      {triangular && narrow && shape.largest_block <= kTinyBlock,
       {"lapack_band", kDefault, "block triangular with tiny blocks: a band of numbers"}},
      {triangular, {"block_substitution", kDefault, "block triangular: substitution has no fill"}},
      {definite && narrow && shape.largest_block <= kSmallBlock,
       {"lapack_band", kDefault, "definite, a narrow band of small blocks: a band of numbers"}},
      {definite && narrow,
       {"block_banded", kDefault, "definite, a narrow band: dense factors of its blocks"}},
      {definite, {"cholmod_llt", kAmd, "definite, no narrow band: sparse Cholesky factors"}},
      {quasi_definite,
       {"cholmod_ldlt", kNatural, "quasi-definite: LDL' without pivoting, in the given order"}},
      {dense, {"eigen_sparse_lu", kDefault, "many entries in a row: sparse LU by supernodes"}},
      {true, {"klu", kDefault, "few entries in a row: sparse LU, a column at a time"}},
  };
}

/// "" if a solver takes the options, or why it does not.
std::string objection(const SolverEntry& entry, const SolverOptions& options) {
  const auto list = [](const auto& offered) {
    std::string names;
    for (const auto& one : offered) {
      names += concat(names.empty() ? "" : ", ", name_of(one));
    }
    return names;
  };
  if (!entry.claims(options.structure)) {
    return concat(entry.name, " is not for matrices of structure \"", name_of(options.structure),
                  "\"; it takes: ", list(entry.structures));
  }
  if (!entry.offers(options.ordering)) {
    return concat(entry.name, " has no ordering \"", name_of(options.ordering),
                  "\"; it offers: ", list(entry.orderings));
  }
  if (options.index_width == IndexWidth::k64 && !entry.has_64_bit_indices) {
    return concat(entry.name, " has no 64-bit indices");
  }
  if (entry.name == "block_substitution" && options.block_sizes.empty()) {
    return "block_substitution needs the sizes of the diagonal blocks; there are none";
  }
  return {};
}

}  // namespace

SolverChoice choose_solver(const SolverOptions& options, const SparseMatrix& A) {
  const std::vector<SolverEntry> available = available_solvers();
  for (auto& [fits, choice] : rules(options, shape_of(options, A))) {
    if (!fits) {
      continue;
    }
    const auto named = [&name = choice.name](const SolverEntry& entry) {
      return entry.name == name;
    };
    const auto entry = std::find_if(available.begin(), available.end(), named);
    if (entry == available.end()) {
      continue;
    }
    // Whether a matrix is block triangular is checked, not assumed.
    SolverOptions seen = options;
    if (choice.name == "block_substitution") {
      seen.structure = Structure::kBlockTriangular;
    }
    if (!objection(*entry, seen).empty()) {
      continue;
    }
    SolverChoice chosen = choice;
    if (options.ordering != Ordering::kDefault) {
      chosen.ordering = options.ordering;
    }
    return chosen;
  }
  throw InvalidInput(concat("auto: no solver for structure \"", name_of(options.structure),
                            "\" with ordering \"", name_of(options.ordering), "\"",
                            options.index_width == IndexWidth::k64 ? " and 64-bit indices" : "",
                            "; use ordering \"default\", or choose a solver by its name"));
}

std::unique_ptr<LinearSolver> make_solver(std::string_view name, const SolverOptions& options,
                                          const SparseMatrix& A) {
  if (name == "auto") {
    const SolverChoice choice = choose_solver(options, A);
    SolverOptions chosen = options;
    chosen.ordering = choice.ordering;
    return find_solver(choice.name).make(chosen);
  }
  const SolverEntry& entry = find_solver(name);
  const std::string reason = objection(entry, options);
  if (!reason.empty()) {
    throw InvalidInput(concat("make_solver: ", reason));
  }
  return entry.make(options);
}

SolverFactory solver_factory(std::string_view name, Ordering ordering) {
  if (name != "auto") {
    static_cast<void>(find_solver(name));
  }
  return [name = std::string(name), ordering](SolverOptions options, const SparseMatrix& A) {
    options.ordering = ordering;
    return make_solver(name, options, A);
  };
}

}  // namespace hbar::solvers
