#include "hbar/solvers/linear/mumps.h"

#include <dmumps_c.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <new>
#include <numeric>

#include "hbar/solvers/linear/mutual_exclusion.h"
#include "hbar/solvers/linear/suitesparse.h"

namespace hbar::solvers {
namespace {

// MUMPS' codes for what it is to do, and for the stand-in of a communicator.
constexpr int kInitialize = -1;
constexpr int kTerminate = -2;
constexpr int kAnalyze = 1;
constexpr int kFactorize = 2;
constexpr int kSolve = 3;
constexpr int kWorldCommunicator = -987654;

// MUMPS' codes for the kind of matrix. Its own for definite ones, 1, cannot tell null pivots: they
// are symmetric ones that are hardly pivoted.
constexpr int kUnsymmetric = 0;
constexpr int kSymmetric = 2;

// Workspace beyond MUMPS' estimate, in percent, at the first and at later tries.
constexpr std::array<int, 3> kHeadroom = {20, 100, 400};

/// ICNTL(7): 1 takes the order of perm_in, 7 leaves the choice to MUMPS.
int code_of(Ordering ordering) {
  using enum Ordering;
  refuse_other_orderings("mumps", ordering, {kDefault, kNatural, kAmd, kMetis});
  if (ordering == kNatural) {
    return 1;
  }
  if (ordering == kAmd) {
    return 0;
  }
  return ordering == kMetis ? 5 : 7;
}

/// What MUMPS' codes mean that a call of ours can meet (its manual, under INFOG(1)).
const char* words_of(int code) {
  switch (code) {
    case -6:
      return "the matrix is structurally singular: no order of its rows gives a diagonal without "
             "zeros";
    case -37:
    case -38:
    case -39:
      return "the ordering failed";
    case -51:
    case -52:
      return "the matrix is too large for the indices of the ordering";
    case -90:
      return "writing factors to a file failed";
    default:
      return "it gave up";
  }
}

class Mumps final : public LinearSolver {
 public:
  explicit Mumps(const SolverOptions& options)
      : ordering_(code_of(options.ordering)),
        is_definite_(options.structure == Structure::kDefinite),
        is_symmetric_(is_definite_ || options.structure == Structure::kQuasiDefinite) {}
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;
  ~Mumps() override { release(); }

  [[nodiscard]] std::string name() const override { return "mumps"; }
  [[nodiscard]] FactorInfo factor_info() const override { return info_; }

 private:
  [[nodiscard]] bool needs_symmetry() const override { return is_symmetric_; }

  void do_analyze() override {
    release();
    id_ = {};
    id_.sym = is_symmetric_ ? kSymmetric : kUnsymmetric;
    id_.par = 1;
    id_.comm_fortran = kWorldCommunicator;
    call(kInitialize);
    is_open_ = id_.infog[0] >= 0;
    if (!is_open_) {
      throw_status("analyze");
    }
    try {
      list_entries();
    } catch (const std::bad_alloc&) {
      throw_out_of_memory("analyze");
    }
    set_controls();
    {
      const auto lock = suitesparse::lock_metis(Ordering::kMetis);  // MUMPS may choose METIS
      call(kAnalyze);
    }
    if (id_.infog[0] < 0) {
      throw_status("analyze");
    }
  }

  void do_factorize() override {
    for (std::size_t k = 0; k < from_.size(); ++k) {
      values_[k] = matrix().valuePtr()[from_[k]];
    }
    for (const int headroom : kHeadroom) {
      icntl(14) = headroom;
      call(kFactorize);
      if (!wants_workspace()) {
        break;
      }
    }
    const int status = id_.infog[0];
    if (status == -10) {
      throw_rank(id_.infog[1]);
    }
    if (status < 0) {
      throw_status("factorize");
    }
    if (id_.infog[27] > 0) {
      throw_null_pivot(id_.pivnul_list[0] - 1);
    }
    if (is_definite_ && id_.infog[11] > 0) {
      throw_indefinite();
    }
    measure();
  }

  void do_solve(System system, MatrixSpan X) override {
    if (X.cols() == 0) {
      return;
    }
    icntl(9) = system == System::kPlain ? 1 : 2;
    id_.rhs = X.data();
    id_.nrhs = static_cast<int>(X.cols());
    id_.lrhs = static_cast<int>(X.outerStride());
    call(kSolve);
    if (id_.infog[0] < 0) {
      throw_status("solve");
    }
  }

  void call(int job) {
    const std::scoped_lock lock(mumps_mutex());
    id_.job = job;
    dmumps_c(&id_);
  }

  void release() {
    if (is_open_) {
      call(kTerminate);
    }
    is_open_ = false;
  }

  /// Rows and columns from 1, of one triangle where that is enough.
  void list_entries() {
    rows_.clear();
    columns_.clear();
    from_.clear();
    for (int j = 0; j < size(); ++j) {
      for (int k = matrix().outerIndexPtr()[j]; k < matrix().outerIndexPtr()[j + 1]; ++k) {
        const int row = matrix().innerIndexPtr()[k];
        if (is_symmetric_ && row < j) {
          continue;
        }
        rows_.push_back(row + 1);
        columns_.push_back(j + 1);
        from_.push_back(k);
      }
    }
    values_.assign(from_.size(), 0.0);
    place_.resize(static_cast<std::size_t>(size()));
    std::iota(place_.begin(), place_.end(), 1);
  }

  void set_controls() {
    for (int stream = 1; stream <= 3; ++stream) {
      icntl(stream) = -1;
    }
    icntl(4) = 0;  // no messages
    // A matching of rows and columns is for matrices without a diagonal; by pattern alone.
    icntl(6) = !is_symmetric_ && !has_diagonal() ? 1 : 0;
    icntl(7) = ordering_;
    icntl(10) = 0;  // no refinement: LinearSolver has its own
    icntl(24) = 1;  // tell null pivots
    id_.cntl[2] = kPivotFloor;
    // The diagonal of a definite matrix suffices; with 0 MUMPS would not report null pivots either.
    if (is_definite_) {
      id_.cntl[0] = 1e-10;
    }
    id_.n = size();
    id_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    id_.irn = rows_.data();
    id_.jcn = columns_.data();
    id_.a = values_.data();
    id_.perm_in = ordering_ == 1 ? place_.data() : nullptr;
  }

  [[nodiscard]] bool has_diagonal() const {
    std::size_t found = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      found += rows_[k] == columns_[k] ? 1 : 0;
    }
    return found == static_cast<std::size_t>(size());
  }

  [[nodiscard]] bool wants_workspace() const {
    constexpr std::array<int, 6> kCodes = {-8, -9, -14, -15, -17, -20};
    return std::find(kCodes.begin(), kCodes.end(), id_.infog[0]) != kCodes.end();
  }

  void measure() {
    // A negative number counts millions.
    const double counted = id_.infog[28];
    const double stored = counted >= 0.0 ? counted : -1e6 * counted;
    info_.entries = is_symmetric_ ? 2.0 * stored - size() : stored;
    // Whole megabytes.
    info_.bytes = std::max(1e6 * static_cast<double>(id_.infog[21]), 8.0 * stored);
    info_.flops = id_.rinfog[2];
    if (is_symmetric_) {
      const int negative = id_.infog[11];
      info_.inertia = Inertia{.positive = size() - negative, .negative = negative, .zero = 0};
    }
  }

  [[noreturn]] void throw_null_pivot(int row) const {
    throw NumericalFailure(concat("mumps: factorize: the matrix (", size(), " x ", size(),
                                  ") is singular to working precision: the pivot in ",
                                  named("row", row), " is less than ", kPivotFloor,
                                  "; look for an unknown without stiffness or inertia, or for ",
                                  "equations that repeat each other"));
  }

  [[noreturn]] void throw_rank(int pivots) const {
    throw NumericalFailure(concat("mumps: factorize: the matrix (", size(), " x ", size(),
                                  ") is singular to working precision: there is no pivot after ",
                                  pivots, "; look for an unknown without stiffness or inertia, or ",
                                  "for equations that repeat each other"));
  }

  [[noreturn]] void throw_indefinite() const {
    throw NumericalFailure(concat("mumps: factorize: the matrix (", size(), " x ", size(),
                                  ") is not positive definite; use a solver for quasi-definite or ",
                                  "general matrices"));
  }

  [[noreturn]] void throw_status(const char* where) const {
    constexpr std::array<int, 4> kNoMemory = {-5, -7, -13, -19};
    const bool no_memory =
        std::find(kNoMemory.begin(), kNoMemory.end(), id_.infog[0]) != kNoMemory.end();
    if (no_memory || wants_workspace()) {
      throw_out_of_memory(where);
    }
    throw NumericalFailure(concat("mumps: ", where, ": ", words_of(id_.infog[0]),
                                  " (INFOG(1) = ", id_.infog[0], ", INFOG(2) = ", id_.infog[1],
                                  "); try another solver or ordering"));
  }

  /// MUMPS' manual counts from 1.
  [[nodiscard]] int& icntl(int number) { return id_.icntl[number - 1]; }

  int ordering_;
  bool is_definite_;
  bool is_symmetric_;
  bool is_open_ = false;
  DMUMPS_STRUC_C id_ = {};
  std::vector<int> rows_;
  std::vector<int> columns_;
  std::vector<int> from_;  // entry of matrix() that each value is copied from
  std::vector<double> values_;
  std::vector<int> place_;  // of each unknown in the natural order
  FactorInfo info_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_mumps(const SolverOptions& options) {
  return std::make_unique<Mumps>(options);
}

}  // namespace hbar::solvers
