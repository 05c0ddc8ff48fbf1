#include "hbar/solvers/umfpack.h"

#include <umfpack.h>

#include <array>
#include <new>
#include <vector>

namespace hbar::solvers {
namespace {

class Umfpack final : public LinearSolver {
 public:
  Umfpack() {
    umfpack_di_defaults(control_.data());
    control_[UMFPACK_PRL] = 0.0;
    control_[UMFPACK_IRSTEP] = 0.0;
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_AUTO;
    control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_AMD;
    control_[UMFPACK_SCALE] = UMFPACK_SCALE_MAX;  // rows by their largest entry, as row_scale()
  }
  Umfpack(const Umfpack&) = delete;
  Umfpack& operator=(const Umfpack&) = delete;
  ~Umfpack() override { release(); }

  [[nodiscard]] std::string name() const override { return "umfpack"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    if (numeric_ == nullptr) return {};
    return {.entries = info_[UMFPACK_LNZ] + info_[UMFPACK_UNZ],
            .bytes = info_[UMFPACK_PEAK_MEMORY] * info_[UMFPACK_SIZE_OF_UNIT],
            .flops = info_[UMFPACK_FLOPS],
            .inertia = {}};
  }

 private:
  void do_analyze() override {
    release();
    const auto n = static_cast<std::size_t>(size());
    const int status = umfpack_di_symbolic(size(), size(), columns(), rows(), nullptr, &symbolic_,
                                           control_.data(), info_.data());
    if (status != UMFPACK_OK) throw_status("analyze", status);
    integer_work_.resize(n);
    work_.resize(n);
    solution_.resize(size());
    pivots_.resize(n);
    pivot_rows_.resize(n);
    pivot_columns_.resize(n);
  }

  void do_factorize() override {
    if (numeric_ != nullptr) umfpack_di_free_numeric(&numeric_);
    const int status = umfpack_di_numeric(columns(), rows(), matrix().valuePtr(), symbolic_,
                                          &numeric_, control_.data(), info_.data());
    if (status != UMFPACK_OK && status != UMFPACK_WARNING_singular_matrix) {
      throw_status("factorize", status);
    }
    int reciprocal = 0;
    const int got = umfpack_di_get_numeric(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
                                           pivot_rows_.data(), pivot_columns_.data(),
                                           pivots_.data(), &reciprocal, nullptr, numeric_);
    if (got != UMFPACK_OK) throw_status("factorize", got);
    const int small = find_small_pivot(pivots_, pivot_columns_);
    if (small >= 0) {
      const auto k = static_cast<std::size_t>(small);
      throw_singular(pivot_rows_[k], pivot_columns_[k], pivots_[k]);
    }
    if (status != UMFPACK_OK) throw_status("factorize", status);
  }

  void do_solve(System system, MatrixSpan X) override {
    const int code = system == System::kPlain ? UMFPACK_A : UMFPACK_At;
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      const int status = umfpack_di_wsolve(
          code, columns(), rows(), matrix().valuePtr(), solution_.data(), X.col(j).data(), numeric_,
          control_.data(), info_.data(), integer_work_.data(), work_.data());
      if (status != UMFPACK_OK) throw_status("solve", status);
      X.col(j) = solution_;
    }
  }

  [[noreturn]] void throw_status(const char* where, int status) const {
    if (status == UMFPACK_ERROR_out_of_memory) throw_out_of_memory(where);
    throw NumericalFailure(
        concat("umfpack: ", where, ": status ", status, "; its meaning is in umfpack.h"));
  }

  [[nodiscard]] const int* columns() const { return matrix().outerIndexPtr(); }
  [[nodiscard]] const int* rows() const { return matrix().innerIndexPtr(); }

  void release() {
    if (numeric_ != nullptr) umfpack_di_free_numeric(&numeric_);
    if (symbolic_ != nullptr) umfpack_di_free_symbolic(&symbolic_);
  }

  std::array<double, UMFPACK_CONTROL> control_ = {};
  std::array<double, UMFPACK_INFO> info_ = {};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
  std::vector<int> integer_work_;
  std::vector<double> work_;
  Eigen::VectorXd solution_;
  std::vector<double> pivots_;
  std::vector<int> pivot_rows_;
  std::vector<int> pivot_columns_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_umfpack(const SolverOptions& /*options*/) {
  return std::make_unique<Umfpack>();
}

}  // namespace hbar::solvers
