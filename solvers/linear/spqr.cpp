#include "hbar/solvers/linear/spqr.h"

#include <SuiteSparseQR.hpp>

#include "hbar/solvers/linear/suitesparse.h"

namespace hbar::solvers {
namespace {

using suitesparse::IndexArrays;
using suitesparse::WideIndex;
using Factorization = SuiteSparseQR_factorization<double>;

int spqr_ordering(Ordering ordering) {
  switch (ordering) {
    case Ordering::kNatural:
      return SPQR_ORDERING_NATURAL;
    case Ordering::kAmd:
      return SPQR_ORDERING_AMD;
    case Ordering::kMetis:
      return SPQR_ORDERING_METIS;
    case Ordering::kDefault:
    case Ordering::kColamd:
    case Ordering::kNested:
      break;
  }
  return SPQR_ORDERING_COLAMD;
}

/// QR of the matrix with its rows divided by their largest entries and its columns then by their
/// lengths, so that one tolerance fits every column.
class Spqr final : public LinearSolver {
 public:
  explicit Spqr(Ordering ordering) : ordering_(ordering) {
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.try_catch = 1;  // no messages: the status tells
    common_.useGPU = 0;
    suitesparse::use_one_thread(common_);
    common_.SPQR_grain = 1.0;  // older versions use TBB where they find it
    common_.SPQR_nthreads = 1;
  }
  Spqr(const Spqr&) = delete;
  Spqr& operator=(const Spqr&) = delete;
  ~Spqr() override {
    release();
    cholmod_l_finish(&common_);
  }

  [[nodiscard]] std::string name() const override { return "spqr"; }
  [[nodiscard]] FactorInfo factor_info() const override { return info_; }

 private:
  /// A dense matrix that CHOLMOD has allocated.
  class Dense {
   public:
    Dense(cholmod_dense* matrix, cholmod_common& common) : matrix_(matrix), common_(common) {}
    Dense(const Dense&) = delete;
    Dense& operator=(const Dense&) = delete;
    ~Dense() { cholmod_l_free_dense(&matrix_, &common_); }
    [[nodiscard]] cholmod_dense* get() const { return matrix_; }
    [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> values() const {
      return {static_cast<const double*>(matrix_->x), static_cast<Eigen::Index>(matrix_->nrow),
              static_cast<Eigen::Index>(matrix_->ncol)};
    }

   private:
    cholmod_dense* matrix_;
    cholmod_common& common_;
  };

  void do_analyze() override {
    release();
    common_.memory_usage = common_.memory_inuse;  // the peak of this matrix alone
    indices_.assign(matrix());
    values_.resize(static_cast<std::size_t>(matrix().nonZeros()));
    row_factor_.resize(size());
    column_factor_.resize(size());
    view_.nrow = static_cast<std::size_t>(size());
    view_.ncol = view_.nrow;
    view_.nzmax = values_.size();
    view_.p = indices_.columns();
    view_.i = indices_.rows();
    view_.x = values_.data();
    view_.itype = CHOLMOD_LONG;
    view_.xtype = CHOLMOD_REAL;
    view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = 1;
    view_.packed = 1;
    const auto lock = suitesparse::lock_metis(ordering_);
    const int detect_rank = 1;
    qr_ = SuiteSparseQR_symbolic<double>(spqr_ordering(ordering_), detect_rank, &view_, &common_);
    if (qr_ == nullptr || common_.status < CHOLMOD_OK) {
      throw_status("analyze");
    }
  }

  void do_factorize() override {
    info_ = {};
    // What was found to have a lower rank leaves a permutation behind that the next would keep.
    if (qr_->Rmap != nullptr) {
      do_analyze();
    }
    scale_values();
    const int ok = SuiteSparseQR_numeric<double>(kPivotFloor, &view_, qr_, &common_);
    if (ok == 0 || common_.status < CHOLMOD_OK) {
      throw_status("factorize");
    }
    if (qr_->rank < size()) {
      refuse_dead_column();
    }
    info_.entries = static_cast<double>(common_.SPQR_istat[0]) +  // R
                    static_cast<double>(common_.SPQR_istat[1]);   // Householder vectors
    info_.bytes = static_cast<double>(common_.memory_usage);
    info_.flops = common_.SPQR_flopcount_bound;  // met, as the matrix has full rank
  }

  void scale_values() {
    for (int i = 0; i < size(); ++i) {
      row_factor_[i] = row_scale()[i] > 0.0 ? 1.0 / row_scale()[i] : 1.0;
    }
    const int* begin = matrix().outerIndexPtr();
    const int* rows = matrix().innerIndexPtr();
    for (int j = 0; j < size(); ++j) {
      const auto first = static_cast<std::size_t>(begin[j]);
      Eigen::Map<Eigen::VectorXd> column(values_.data() + first, begin[j + 1] - begin[j]);
      for (Eigen::Index k = 0; k < column.size(); ++k) {
        column[k] = matrix().valuePtr()[begin[j] + k] * row_factor_[rows[begin[j] + k]];
      }
      const double length = column.norm();
      column_factor_[j] = length > 0.0 ? 1.0 / length : 1.0;
      column *= column_factor_[j];
    }
  }

  [[noreturn]] void refuse_dead_column() const {
    WideIndex k = 0;
    while (qr_->QRnum->Rdead != nullptr && k + 1 < size() && qr_->QRnum->Rdead[k] == 0) {
      ++k;
    }
    const WideIndex* order = qr_->QRsym->Qfill;
    const int column = static_cast<int>(order == nullptr ? k : order[k]);
    // QR has no pivot rows: the row to look at is the one that depends most on the unknown.
    const int begin = matrix().outerIndexPtr()[column];
    const int* rows = matrix().innerIndexPtr() + begin;
    const int count = matrix().outerIndexPtr()[column + 1] - begin;
    const auto weight = [this, rows, begin](int entry) {
      return std::abs(matrix().valuePtr()[begin + entry]) * row_factor_[rows[entry]];
    };
    int largest = 0;
    for (int entry = 1; entry < count; ++entry) {
      if (weight(entry) > weight(largest)) {
        largest = entry;
      }
    }
    throw_singular(rows[largest], column, common_.SPQR_norm_E_fro);
  }

  void do_solve(System system, MatrixSpan X) override {
    if (X.cols() == 0) {
      return;
    }
    if (system == System::kPlain) {
      rhs_ = row_factor_.asDiagonal() * X;
      cholmod_dense view = view_of(rhs_);
      const Dense rotated(SuiteSparseQR_qmult<double>(SPQR_QTX, qr_, &view, &common_), common_);
      if (rotated.get() == nullptr) {
        throw_status("solve");
      }
      const Dense solution(
          SuiteSparseQR_solve<double>(SPQR_RETX_EQUALS_B, qr_, rotated.get(), &common_), common_);
      if (solution.get() == nullptr) {
        throw_status("solve");
      }
      X = column_factor_.asDiagonal() * solution.values();
    } else {
      rhs_ = column_factor_.asDiagonal() * X;
      cholmod_dense view = view_of(rhs_);
      const Dense rotated(SuiteSparseQR_solve<double>(SPQR_RTX_EQUALS_ETB, qr_, &view, &common_),
                          common_);
      if (rotated.get() == nullptr) {
        throw_status("solve");
      }
      const Dense solution(SuiteSparseQR_qmult<double>(SPQR_QX, qr_, rotated.get(), &common_),
                           common_);
      if (solution.get() == nullptr) {
        throw_status("solve");
      }
      X = row_factor_.asDiagonal() * solution.values();
    }
  }

  static cholmod_dense view_of(Eigen::MatrixXd& B) {
    cholmod_dense view = {};
    view.nrow = static_cast<std::size_t>(B.rows());
    view.ncol = static_cast<std::size_t>(B.cols());
    view.d = view.nrow;
    view.nzmax = view.nrow * view.ncol;
    view.x = B.data();
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    return view;
  }

  [[noreturn]] void throw_status(const char* where) const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) {
      throw_out_of_memory(where);
    }
    throw NumericalFailure(
        concat("spqr: ", where, ": status ", common_.status, "; its meaning is in cholmod.h"));
  }

  void release() {
    if (qr_ != nullptr) {
      SuiteSparseQR_free<double>(&qr_, &common_);
    }
    qr_ = nullptr;
  }

  Ordering ordering_;
  cholmod_common common_ = {};
  IndexArrays<WideIndex> indices_;
  cholmod_sparse view_ = {};
  std::vector<double> values_;
  Eigen::VectorXd row_factor_;
  Eigen::VectorXd column_factor_;
  Eigen::MatrixXd rhs_;
  Factorization* qr_ = nullptr;
  FactorInfo info_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_spqr(const SolverOptions& options) {
  using enum Ordering;
  refuse_other_orderings("spqr", options.ordering, {kDefault, kNatural, kAmd, kColamd, kMetis});
  return std::make_unique<Spqr>(options.ordering);
}

}  // namespace hbar::solvers
