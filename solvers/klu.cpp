#include "hbar/solvers/klu.h"

#include <klu.h>

#include <new>

namespace hbar::solvers {
namespace {

// Below this ratio of matrix to factor entries a kept pivot order has let the factors grow too far.
constexpr double kGrowthFloor = 1e-3;

class Klu final : public LinearSolver {
 public:
  Klu() { klu_defaults(&common_); }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;
  ~Klu() override { release(); }

  [[nodiscard]] std::string name() const override { return "klu"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    if (numeric_ == nullptr) return {};
    return {.entries = static_cast<double>(numeric_->lnz + numeric_->unz + numeric_->nzoff),
            .bytes = static_cast<double>(common_.memusage),
            .flops = {},
            .inertia = {}};
  }

 private:
  void do_analyze() override {
    release();
    common_.scale = 2;  // rows divided by their largest entry, as row_scale()
    symbolic_ = klu_analyze(size(), columns(), rows(), &common_);
    if (symbolic_ == nullptr) throw_status("analyze");
  }

  void do_factorize() override {
    if (numeric_ != nullptr && refactorize()) {
      count_refactorization();
      return;
    }
    klu_free_numeric(&numeric_, &common_);
    numeric_ = klu_factor(columns(), rows(), values(), symbolic_, &common_);
    // A structurally singular matrix has no numeric object; then KLU names the column it failed at.
    if (common_.status == KLU_SINGULAR || numeric_ == nullptr) {
      const int k = common_.numerical_rank;
      klu_free_numeric(&numeric_, &common_);
      if (common_.status != KLU_SINGULAR) throw_status("factorize");
      throw_singular(k >= 0 && k < size() ? symbolic_->P[k] : 0, common_.singular_col, 0.0);
    }
    const int small = find_small_pivot(pivots(), pivot_columns());
    if (small >= 0) {
      const int row = numeric_->Pnum[small];
      const double pivot = pivots()[static_cast<std::size_t>(small)];
      klu_free_numeric(&numeric_, &common_);
      throw_singular(row, symbolic_->Q[small], pivot);
    }
  }

  /// New values in the old pivot order; false if that order does not suit them.
  bool refactorize() {
    if (klu_refactor(columns(), rows(), values(), symbolic_, numeric_, &common_) == 0 ||
        common_.status != KLU_OK) {
      return false;
    }
    if (klu_rgrowth(columns(), rows(), values(), symbolic_, numeric_, &common_) == 0) return false;
    return common_.rgrowth > kGrowthFloor && find_small_pivot(pivots(), pivot_columns()) < 0;
  }

  void do_solve(System system, MatrixSpan X) override {
    const int stride = static_cast<int>(X.outerStride());
    const int count = static_cast<int>(X.cols());
    if (count == 0) return;
    const int ok = system == System::kPlain
                       ? klu_solve(symbolic_, numeric_, stride, count, X.data(), &common_)
                       : klu_tsolve(symbolic_, numeric_, stride, count, X.data(), &common_);
    if (ok == 0) throw_status("solve");
  }

  [[noreturn]] void throw_status(const char* where) const {
    if (common_.status == KLU_OUT_OF_MEMORY) throw_out_of_memory(where);
    const char* reason = common_.status == KLU_TOO_LARGE
                             ? " (more entries than 32-bit indices can count; use smaller blocks)"
                             : "";
    throw NumericalFailure(concat("klu: ", where, ": status ", common_.status, reason));
  }

  [[nodiscard]] std::span<const double> pivots() const {
    return {static_cast<const double*>(numeric_->Udiag), static_cast<std::size_t>(size())};
  }
  [[nodiscard]] std::span<const int> pivot_columns() const {
    return {symbolic_->Q, static_cast<std::size_t>(size())};
  }

  // KLU takes its inputs as pointers to non-const and does not write to them.
  [[nodiscard]] int* columns() const { return const_cast<int*>(matrix().outerIndexPtr()); }
  [[nodiscard]] int* rows() const { return const_cast<int*>(matrix().innerIndexPtr()); }
  [[nodiscard]] double* values() const { return const_cast<double*>(matrix().valuePtr()); }

  void release() {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }

  klu_common common_ = {};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<LinearSolver> make_klu(const SolverOptions& /*options*/) {
  return std::make_unique<Klu>();
}

}  // namespace hbar::solvers
