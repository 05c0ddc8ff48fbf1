#include "hbar/solvers/linear/klu.h"

#include <klu.h>

#include "hbar/solvers/linear/suitesparse.h"

namespace hbar::solvers {
namespace {

using suitesparse::IndexArrays;
using suitesparse::WideIndex;

// Below this ratio of matrix to factor entries a kept pivot order has let the factors grow too far.
constexpr double kGrowthFloor = 1e-3;

/// KLU's types and functions for a width of index.
template <typename Index>
struct Api;

template <>
struct Api<int> {
  using Common = klu_common;
  using Symbolic = klu_symbolic;
  using Numeric = klu_numeric;
  static constexpr auto kDefaults = &klu_defaults;
  static constexpr auto kAnalyze = &klu_analyze;
  static constexpr auto kAnalyzeGiven = &klu_analyze_given;
  static constexpr auto kFactor = &klu_factor;
  static constexpr auto kRefactor = &klu_refactor;
  static constexpr auto kGrowth = &klu_rgrowth;
  static constexpr auto kFlops = &klu_flops;
  static constexpr auto kSolve = &klu_solve;
  static constexpr auto kSolveTransposed = &klu_tsolve;
  static constexpr auto kFreeNumeric = &klu_free_numeric;
  static constexpr auto kFreeSymbolic = &klu_free_symbolic;
};

template <>
struct Api<WideIndex> {
  using Common = klu_l_common;
  using Symbolic = klu_l_symbolic;
  using Numeric = klu_l_numeric;
  static constexpr auto kDefaults = &klu_l_defaults;
  static constexpr auto kAnalyze = &klu_l_analyze;
  static constexpr auto kAnalyzeGiven = &klu_l_analyze_given;
  static constexpr auto kFactor = &klu_l_factor;
  static constexpr auto kRefactor = &klu_l_refactor;
  static constexpr auto kGrowth = &klu_l_rgrowth;
  static constexpr auto kFlops = &klu_l_flops;
  static constexpr auto kSolve = &klu_l_solve;
  static constexpr auto kSolveTransposed = &klu_l_tsolve;
  static constexpr auto kFreeNumeric = &klu_l_free_numeric;
  static constexpr auto kFreeSymbolic = &klu_l_free_symbolic;
};

template <typename Index>
class Klu final : public LinearSolver {
 public:
  explicit Klu(Ordering ordering) : natural_(ordering == Ordering::kNatural) {
    Calls::kDefaults(&common_);
    common_.scale = 2;  // rows divided by their largest entry, as row_scale()
    common_.ordering = ordering == Ordering::kColamd ? 1 : 0;
    common_.btf = natural_ ? 0 : 1;
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;
  ~Klu() override { release(); }

  [[nodiscard]] std::string name() const override { return "klu"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    if (numeric_ == nullptr) {
      return {};
    }
    typename Calls::Common common = common_;  // which KLU writes its count to
    Calls::kFlops(symbolic_, numeric_, &common);
    return {
        .entries = static_cast<double>(numeric_->lnz + numeric_->unz + numeric_->nzoff - size()),
        .bytes = static_cast<double>(common_.memusage),
        .flops = common.flops,
        .inertia = {}};
  }

 private:
  using Calls = Api<Index>;

  void do_analyze() override {
    release();
    indices_.assign(matrix());
    symbolic_ = natural_
                    ? Calls::kAnalyzeGiven(size(), columns(), rows(), nullptr, nullptr, &common_)
                    : Calls::kAnalyze(size(), columns(), rows(), &common_);
    if (symbolic_ == nullptr) {
      throw_status("analyze");
    }
    pivot_columns_.resize(static_cast<std::size_t>(size()));
    suitesparse::narrow_indices(symbolic_->Q, pivot_columns_);
  }

  void do_factorize() override {
    if (numeric_ != nullptr && refactorize()) {
      count_refactorization();
      return;
    }
    Calls::kFreeNumeric(&numeric_, &common_);
    numeric_ = Calls::kFactor(columns(), rows(), values(), symbolic_, &common_);
    // A structurally singular matrix has no numeric object; then KLU names the column it failed at.
    if (common_.status == KLU_SINGULAR || numeric_ == nullptr) {
      const Index k = common_.numerical_rank;
      Calls::kFreeNumeric(&numeric_, &common_);
      if (common_.status != KLU_SINGULAR) {
        throw_status("factorize");
      }
      throw_singular(k >= 0 && k < size() ? static_cast<int>(symbolic_->P[k]) : 0,
                     static_cast<int>(common_.singular_col), 0.0);
    }
    const int small = find_small_pivot(pivots(), pivot_columns_);
    if (small >= 0) {
      const auto k = static_cast<std::size_t>(small);
      const int row = static_cast<int>(numeric_->Pnum[k]);
      const double pivot = pivots()[k];
      Calls::kFreeNumeric(&numeric_, &common_);
      throw_singular(row, pivot_columns_[k], pivot);
    }
  }

  /// New values in the old pivot order; false if that order does not suit them.
  bool refactorize() {
    if (Calls::kRefactor(columns(), rows(), values(), symbolic_, numeric_, &common_) == 0 ||
        common_.status != KLU_OK) {
      return false;
    }
    if (Calls::kGrowth(columns(), rows(), values(), symbolic_, numeric_, &common_) == 0) {
      return false;
    }
    return common_.rgrowth > kGrowthFloor && find_small_pivot(pivots(), pivot_columns_) < 0;
  }

  void do_solve(System system, MatrixSpan X) override {
    const auto stride = static_cast<Index>(X.outerStride());
    const auto count = static_cast<Index>(X.cols());
    if (count == 0) {
      return;
    }
    const auto solve = system == System::kPlain ? Calls::kSolve : Calls::kSolveTransposed;
    if (solve(symbolic_, numeric_, stride, count, X.data(), &common_) == 0) {
      throw_status("solve");
    }
  }

  [[noreturn]] void throw_status(const char* where) const {
    if (common_.status == KLU_OUT_OF_MEMORY) {
      throw_out_of_memory(where);
    }
    const char* reason = common_.status == KLU_TOO_LARGE
                             ? " (more entries than the indices can count; take 64-bit indices or "
                               "smaller blocks)"
                             : "";
    throw NumericalFailure(concat("klu: ", where, ": status ", common_.status, reason));
  }

  [[nodiscard]] std::span<const double> pivots() const {
    return {static_cast<const double*>(numeric_->Udiag), static_cast<std::size_t>(size())};
  }

  [[nodiscard]] Index* columns() const { return indices_.columns(); }
  [[nodiscard]] Index* rows() const { return indices_.rows(); }
  // KLU takes its inputs as pointers to non-const and does not write to them.
  [[nodiscard]] double* values() const { return const_cast<double*>(matrix().valuePtr()); }

  void release() {
    Calls::kFreeNumeric(&numeric_, &common_);
    Calls::kFreeSymbolic(&symbolic_, &common_);
  }

  bool natural_;
  typename Calls::Common common_ = {};
  typename Calls::Symbolic* symbolic_ = nullptr;
  typename Calls::Numeric* numeric_ = nullptr;
  IndexArrays<Index> indices_;
  std::vector<int> pivot_columns_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_klu(const SolverOptions& options) {
  using enum Ordering;
  refuse_other_orderings("klu", options.ordering, {kDefault, kNatural, kAmd, kColamd});
  if (options.index_width == IndexWidth::k64) {
    return std::make_unique<Klu<WideIndex>>(options.ordering);
  }
  return std::make_unique<Klu<int>>(options.ordering);
}

}  // namespace hbar::solvers
