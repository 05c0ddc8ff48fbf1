#include "hbar/solvers/linear/lapack_band.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <numeric>
#include <utility>

#include "hbar/solvers/linear/band.h"
#include "hbar/solvers/linear/row_scaling.h"

extern "C" {
void dgbtrf_(const int* m, const int* n, const int* kl, const int* ku, double* ab, const int* ldab,
             int* ipiv, int* info);
// The last argument is the length of `trans`, which Fortran compilers pass unseen.
void dgbtrs_(const char* trans, const int* n, const int* kl, const int* ku, const int* nrhs,
             const double* ab, const int* ldab, const int* ipiv, double* b, const int* ldb,
             int* info, std::size_t trans_length);
}

namespace hbar::solvers {
namespace {

class LapackBand final : public LinearSolver {
 public:
  [[nodiscard]] std::string name() const override { return "lapack_band"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    const double entries = static_cast<double>(band_.size());
    return {.entries = entries,
            .bytes = 8.0 * entries + 28.0 * static_cast<double>(size()),
            .flops = {},
            .inertia = {}};
  }

 private:
  void do_analyze() override {
    const Band band = band_of(matrix());
    lower_ = band.lower;
    upper_ = band.upper;
    refuse_wide_band(name(), matrix(), 8.0 * (2.0 * lower_ + upper_ + 1.0) * size());
    height_ = 2 * lower_ + upper_ + 1;
    const auto n = static_cast<std::size_t>(size());
    try {
      band_.clear();
      band_.resize(static_cast<std::size_t>(height_) * n);
      swaps_.resize(n);
      pivots_.resize(n);
      column_of_.resize(n);
      scale_.resize(size());
    } catch (const std::bad_alloc&) {
      throw_out_of_memory("analyze");
    }
    std::iota(column_of_.begin(), column_of_.end(), 0);
  }

  void do_factorize() override {
    fill_band();
    const int n = size();
    int info = 0;
    dgbtrf_(&n, &n, &lower_, &upper_, band_.data(), &height_, swaps_.data(), &info);
    // A positive number says that a pivot is zero, which is found below.
    if (info < 0) {
      throw NumericalFailure(concat("lapack_band: factorize: dgbtrf returns ", info));
    }
    for (int j = 0; j < n; ++j) {
      pivots_[static_cast<std::size_t>(j)] = band(lower_ + upper_, j);
    }
    const int small = find_small_pivot(pivots_, column_of_);
    if (small >= 0) {
      throw_singular(row_of_pivot(small), small, pivots_[static_cast<std::size_t>(small)]);
    }
  }

  void do_solve(System system, MatrixSpan X) override {
    const int n = size();
    const int count = static_cast<int>(X.cols());
    const int stride = static_cast<int>(X.outerStride());
    if (count == 0) {
      return;
    }
    if (system == System::kPlain) {
      X = scale_.asDiagonal() * X;
    }
    const char trans = system == System::kPlain ? 'N' : 'T';
    int info = 0;
    dgbtrs_(&trans, &n, &lower_, &upper_, &count, band_.data(), &height_, swaps_.data(), X.data(),
            &stride, &info, 1);
    if (info != 0) {
      throw NumericalFailure(concat("lapack_band: solve: dgbtrs returns ", info));
    }
    if (system == System::kTransposed) {
      X = scale_.asDiagonal() * X;
    }
  }

  /// The matrix in LAPACK's layout, its rows scaled.
  void fill_band() {
    set_power_of_two_scales(row_scale(), scale_);
    std::fill(band_.begin(), band_.end(), 0.0);
    for (int j = 0; j < size(); ++j) {
      for (int k = matrix().outerIndexPtr()[j]; k < matrix().outerIndexPtr()[j + 1]; ++k) {
        const int row = matrix().innerIndexPtr()[k];
        band(lower_ + upper_ + row - j, j) = matrix().valuePtr()[k] * scale_[row];
      }
    }
  }

  /// Row of the matrix that was interchanged into place `pivot`.
  [[nodiscard]] int row_of_pivot(int pivot) const {
    std::vector<int> row_of = column_of_;
    for (int i = 0; i <= pivot; ++i) {
      const auto other = static_cast<std::size_t>(swaps_[static_cast<std::size_t>(i)] - 1);
      std::swap(row_of[static_cast<std::size_t>(i)], row_of[other]);
    }
    return row_of[static_cast<std::size_t>(pivot)];
  }

  [[nodiscard]] double& band(int row, int column) {
    return band_[static_cast<std::size_t>(column) * static_cast<std::size_t>(height_) +
                 static_cast<std::size_t>(row)];
  }

  int lower_ = 0;   // diagonals below the main one
  int upper_ = 0;   // and above
  int height_ = 0;  // rows of band_
  std::vector<double> band_;
  std::vector<int> swaps_;  // LAPACK's, from 1
  std::vector<double> pivots_;
  std::vector<int> column_of_;  // column of A of each pivot: its own
  Eigen::VectorXd scale_;       // rows are multiplied by this
};

}  // namespace

std::unique_ptr<LinearSolver> make_lapack_band(const SolverOptions& options) {
  refuse_other_orderings("lapack_band", options.ordering, {Ordering::kDefault, Ordering::kNatural});
  return std::make_unique<LapackBand>();
}

}  // namespace hbar::solvers
