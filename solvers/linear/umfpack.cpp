#include "hbar/solvers/linear/umfpack.h"

#include <umfpack.h>

#include <array>
#include <vector>

#include "hbar/solvers/linear/solver_catalogue.h"
#include "hbar/solvers/linear/suitesparse.h"

namespace hbar::solvers {
namespace {

using suitesparse::IndexArrays;
using suitesparse::WideIndex;

/// UMFPACK's functions for a width of index.
template <typename Index>
struct Api;

template <>
struct Api<int> {
  static constexpr auto kDefaults = &umfpack_di_defaults;
  static constexpr auto kSymbolic = &umfpack_di_symbolic;
  static constexpr auto kNumeric = &umfpack_di_numeric;
  static constexpr auto kGetNumeric = &umfpack_di_get_numeric;
  static constexpr auto kSolve = &umfpack_di_wsolve;
  static constexpr auto kFreeNumeric = &umfpack_di_free_numeric;
  static constexpr auto kFreeSymbolic = &umfpack_di_free_symbolic;
};

template <>
struct Api<WideIndex> {
  static constexpr auto kDefaults = &umfpack_dl_defaults;
  static constexpr auto kSymbolic = &umfpack_dl_symbolic;
  static constexpr auto kNumeric = &umfpack_dl_numeric;
  static constexpr auto kGetNumeric = &umfpack_dl_get_numeric;
  static constexpr auto kSolve = &umfpack_dl_wsolve;
  static constexpr auto kFreeNumeric = &umfpack_dl_free_numeric;
  static constexpr auto kFreeSymbolic = &umfpack_dl_free_symbolic;
};

// A pivot is at least this share of the largest in its column: UMFPACK's own choice, which keeps
// factors sparse, and one for matrices whose factors it lets grow too far (of a periodic system of
// condition 2e6 to 3e13).
constexpr double kPivotShare = 0.1;
constexpr double kStrictPivotShare = 0.5;

int strategy_of(Ordering ordering) {
  if (ordering == Ordering::kAmd) {
    return UMFPACK_STRATEGY_SYMMETRIC;
  }
  if (ordering == Ordering::kColamd) {
    return UMFPACK_STRATEGY_UNSYMMETRIC;
  }
  return UMFPACK_STRATEGY_AUTO;
}

int method_of(Ordering ordering) {
  if (ordering == Ordering::kNatural) {
    return UMFPACK_ORDERING_NONE;
  }
  if (ordering == Ordering::kMetis) {
    return UMFPACK_ORDERING_METIS;
  }
  return UMFPACK_ORDERING_AMD;  // AMD or COLAMD, depending on the strategy
}

template <typename Index>
class Umfpack final : public LinearSolver {
 public:
  explicit Umfpack(Ordering ordering) : ordering_(ordering) {
    Api<Index>::kDefaults(control_.data());
    control_[UMFPACK_PRL] = 0.0;
    control_[UMFPACK_IRSTEP] = 0.0;
    control_[UMFPACK_STRATEGY] = strategy_of(ordering);
    control_[UMFPACK_ORDERING] = method_of(ordering);
    control_[UMFPACK_SCALE] = UMFPACK_SCALE_MAX;  // rows by their largest entry, as row_scale()
  }
  Umfpack(const Umfpack&) = delete;
  Umfpack& operator=(const Umfpack&) = delete;
  ~Umfpack() override { release(); }

  [[nodiscard]] std::string name() const override { return "umfpack"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    if (numeric_ == nullptr) {
      return {};
    }
    return {.entries = info_[UMFPACK_LNZ] + info_[UMFPACK_UNZ] - size(),
            .bytes = info_[UMFPACK_PEAK_MEMORY] * info_[UMFPACK_SIZE_OF_UNIT],
            .flops = info_[UMFPACK_FLOPS],
            .inertia = {}};
  }

 private:
  void do_analyze() override {
    release();
    control_[UMFPACK_PIVOT_TOLERANCE] = kPivotShare;
    const auto n = static_cast<std::size_t>(size());
    indices_.assign(matrix());
    {
      const auto lock = suitesparse::lock_metis(ordering_);
      const auto status = static_cast<int>(Api<Index>::kSymbolic(
          size(), size(), columns(), rows(), nullptr, &symbolic_, control_.data(), info_.data()));
      if (status != UMFPACK_OK) {
        throw_status("analyze", status);
      }
    }
    integer_work_.resize(n);
    work_.resize(n);
    solution_.resize(size());
    pivots_.resize(n);
    pivot_rows_.resize(n);
    pivot_columns_.resize(n);
    wide_rows_.resize(n);
    wide_columns_.resize(n);
  }

  void do_factorize() override {
    if (numeric_ != nullptr) {
      Api<Index>::kFreeNumeric(&numeric_);
    }
    const auto status =
        static_cast<int>(Api<Index>::kNumeric(columns(), rows(), matrix().valuePtr(), symbolic_,
                                              &numeric_, control_.data(), info_.data()));
    if (status != UMFPACK_OK && status != UMFPACK_WARNING_singular_matrix) {
      throw_status("factorize", status);
    }
    Index reciprocal = 0;
    const auto got = static_cast<int>(Api<Index>::kGetNumeric(
        nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, wide_rows_.data(),
        wide_columns_.data(), pivots_.data(), &reciprocal, nullptr, numeric_));
    if (got != UMFPACK_OK) {
      throw_status("factorize", got);
    }
    suitesparse::narrow_indices(wide_rows_.data(), pivot_rows_);
    suitesparse::narrow_indices(wide_columns_.data(), pivot_columns_);
    const int small = find_small_pivot(pivots_, pivot_columns_);
    if (small >= 0) {
      const auto k = static_cast<std::size_t>(small);
      throw_singular(pivot_rows_[k], pivot_columns_[k], pivots_[k]);
    }
    if (status != UMFPACK_OK) {
      throw_status("factorize", status);
    }
  }

  /// The strict choice holds until the next analysis.
  bool do_factorize_strictly() override {
    if (control_[UMFPACK_PIVOT_TOLERANCE] == kStrictPivotShare) {
      return false;
    }
    control_[UMFPACK_PIVOT_TOLERANCE] = kStrictPivotShare;
    do_factorize();
    return true;
  }

  void do_solve(System system, MatrixSpan X) override {
    const int code = system == System::kPlain ? UMFPACK_A : UMFPACK_At;
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      const auto status = static_cast<int>(Api<Index>::kSolve(
          code, columns(), rows(), matrix().valuePtr(), solution_.data(), X.col(j).data(), numeric_,
          control_.data(), info_.data(), integer_work_.data(), work_.data()));
      if (status != UMFPACK_OK) {
        throw_status("solve", status);
      }
      X.col(j) = solution_;
    }
  }

  [[noreturn]] void throw_status(const char* where, int status) const {
    if (status == UMFPACK_ERROR_out_of_memory) {
      throw_out_of_memory(where);
    }
    throw NumericalFailure(
        concat("umfpack: ", where, ": status ", status, "; its meaning is in umfpack.h"));
  }

  [[nodiscard]] const Index* columns() const { return indices_.columns(); }
  [[nodiscard]] const Index* rows() const { return indices_.rows(); }

  void release() {
    if (numeric_ != nullptr) {
      Api<Index>::kFreeNumeric(&numeric_);
    }
    if (symbolic_ != nullptr) {
      Api<Index>::kFreeSymbolic(&symbolic_);
    }
  }

  Ordering ordering_;
  IndexArrays<Index> indices_;
  std::array<double, UMFPACK_CONTROL> control_ = {};
  std::array<double, UMFPACK_INFO> info_ = {};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
  std::vector<Index> integer_work_;
  std::vector<double> work_;
  Eigen::VectorXd solution_;
  std::vector<double> pivots_;
  std::vector<int> pivot_rows_;
  std::vector<int> pivot_columns_;
  std::vector<Index> wide_rows_;
  std::vector<Index> wide_columns_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack(const SolverOptions& options) {
  using enum Ordering;
  refuse_other_orderings("umfpack", options.ordering, {kDefault, kNatural, kAmd, kColamd, kMetis});
  if (options.index_width == IndexWidth::k64) {
    return std::make_unique<Umfpack<WideIndex>>(options.ordering);
  }
  return std::make_unique<Umfpack<int>>(options.ordering);
}

bool register_umfpack() { return register_solver("umfpack", make_umfpack); }

}  // namespace hbar::solvers
