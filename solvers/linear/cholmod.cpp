#include "hbar/solvers/linear/cholmod.h"

#include <cholmod.h>

#include "hbar/solvers/linear/suitesparse.h"

namespace hbar::solvers {
namespace {

using suitesparse::IndexArrays;
using suitesparse::WideIndex;

/// CHOLMOD's functions for a width of index.
template <typename Index>
struct Api;

template <>
struct Api<int> {
  static constexpr int kIntegers = CHOLMOD_INT;
  static constexpr auto kStart = &cholmod_start;
  static constexpr auto kFinish = &cholmod_finish;
  static constexpr auto kAnalyze = &cholmod_analyze;
  static constexpr auto kFactorize = &cholmod_factorize;
  static constexpr auto kSolve = &cholmod_solve2;
  static constexpr auto kFreeFactor = &cholmod_free_factor;
  static constexpr auto kFreeDense = &cholmod_free_dense;
};

template <>
struct Api<WideIndex> {
  static constexpr int kIntegers = CHOLMOD_LONG;
  static constexpr auto kStart = &cholmod_l_start;
  static constexpr auto kFinish = &cholmod_l_finish;
  static constexpr auto kAnalyze = &cholmod_l_analyze;
  static constexpr auto kFactorize = &cholmod_l_factorize;
  static constexpr auto kSolve = &cholmod_l_solve2;
  static constexpr auto kFreeFactor = &cholmod_l_free_factor;
  static constexpr auto kFreeDense = &cholmod_l_free_dense;
};

/// One matrix, its factor and what CHOLMOD needs to remember, freed together.
template <typename Index>
class Handle {
 public:
  Handle() {
    Api<Index>::kStart(&common);
    common.print = 0;
    common.try_catch = 1;  // no messages: the status tells
    common.useGPU = 0;
    suitesparse::use_one_thread(common);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    release();
    Api<Index>::kFinish(&common);
  }

  void release() {
    Api<Index>::kFreeDense(&solution, &common);
    Api<Index>::kFreeDense(&solve_work, &common);
    Api<Index>::kFreeDense(&row_work, &common);
    Api<Index>::kFreeFactor(&factor, &common);
  }

  cholmod_common common = {};
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;
  cholmod_dense* solve_work = nullptr;
  cholmod_dense* row_work = nullptr;
};

enum class Kind { kLlt, kSupernodal, kLdlt, kNormal };

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::kLlt:
      return "cholmod_llt";
    case Kind::kSupernodal:
      return "cholmod_supernodal";
    case Kind::kLdlt:
      return "cholmod_ldlt";
    case Kind::kNormal:
      break;
  }
  return "cholmod_normal";
}

Ordering resolved(Kind kind, Ordering ordering) {
  if (ordering != Ordering::kDefault) {
    return ordering;
  }
  if (kind == Kind::kLdlt) {
    return Ordering::kNatural;
  }
  return kind == Kind::kNormal ? Ordering::kColamd : Ordering::kAmd;
}

int method_of(Ordering ordering) {
  switch (ordering) {
    case Ordering::kNatural:
      return CHOLMOD_NATURAL;
    case Ordering::kColamd:
      return CHOLMOD_COLAMD;
    case Ordering::kMetis:
      return CHOLMOD_METIS;
    case Ordering::kNested:
      return CHOLMOD_NESDIS;
    case Ordering::kDefault:
    case Ordering::kAmd:
      break;
  }
  return CHOLMOD_AMD;
}

cholmod_dense view_of(MatrixSpan& X) {
  const auto stride = static_cast<std::size_t>(X.outerStride());
  cholmod_dense view = {};
  view.nrow = static_cast<std::size_t>(X.rows());
  view.ncol = static_cast<std::size_t>(X.cols());
  view.d = stride;
  view.nzmax = stride * (view.ncol - 1) + view.nrow;
  view.x = X.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

template <typename Index>
class Cholmod final : public LinearSolver {
 public:
  Cholmod(Kind kind, Ordering ordering) : kind_(kind), ordering_(resolved(kind, ordering)) {
    cholmod_common& common = handle_.common;
    common.nmethods = 1;
    common.method[0].ordering = method_of(ordering_);
    common.postorder = ordering_ == Ordering::kNatural ? 0 : 1;
    common.supernodal = kind == Kind::kSupernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common.final_asis = 0;
    common.final_super = kind == Kind::kSupernodal ? 1 : 0;
    common.final_ll = kind == Kind::kLdlt ? 0 : 1;
    common.quick_return_if_not_posdef = 1;
  }

  [[nodiscard]] std::string name() const override { return name_of(kind_); }
  [[nodiscard]] FactorInfo factor_info() const override { return info_; }

 private:
  [[nodiscard]] bool needs_symmetry() const override { return kind_ != Kind::kNormal; }

  void do_analyze() override {
    handle_.release();
    handle_.common.memory_usage = handle_.common.memory_inuse;  // the peak of this matrix alone
    indices_.assign(matrix());
    describe_matrix();
    const auto n = static_cast<std::size_t>(size());
    pivots_.resize(n);
    scaled_pivots_.resize(n);
    pivot_rows_.resize(n);
    const auto lock = suitesparse::lock_metis(ordering_);
    handle_.factor = Api<Index>::kAnalyze(&view_, &handle_.common);
    if (handle_.factor == nullptr || handle_.common.status < CHOLMOD_OK) {
      throw_status("analyze", handle_.common.status);
    }
    suitesparse::narrow_indices(static_cast<const Index*>(handle_.factor->Perm), pivot_rows_);
    flops_ = handle_.common.fl - (kind_ == Kind::kLdlt ? static_cast<double>(size()) : 0.0);
  }

  void describe_matrix() {
    view_.nrow = static_cast<std::size_t>(size());
    view_.ncol = view_.nrow;
    view_.nzmax = static_cast<std::size_t>(matrix().nonZeros());
    view_.p = indices_.columns();
    view_.i = indices_.rows();
    view_.x = const_cast<double*>(matrix().valuePtr());  // CHOLMOD does not write to it
    // The triangle that the factorisation can read without transposing the matrix first.
    const bool upper = kind_ != Kind::kSupernodal && ordering_ == Ordering::kNatural;
    view_.stype = kind_ == Kind::kNormal ? 0 : (upper ? 1 : -1);
    view_.itype = Api<Index>::kIntegers;
    view_.xtype = CHOLMOD_REAL;
    view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = 1;
    view_.packed = 1;
  }

  void do_factorize() override {
    info_ = {};
    Api<Index>::kFactorize(&view_, handle_.factor, &handle_.common);
    // The next call overwrites both.
    const int status = handle_.common.status;
    const std::size_t minor = handle_.factor->minor;
    if (status < CHOLMOD_OK) {
      throw_status("factorize", status);
    }
    if (minor < handle_.factor->n) {
      refuse_pivot(minor, 0.0);
    }
    read_pivots();
    refuse_unfit_pivots();
    read_info();
  }

  /// Diagonal of D, or of L squared, in the order of elimination.
  void read_pivots() {
    const cholmod_factor& factor = *handle_.factor;
    const auto* x = static_cast<const double*>(factor.x);
    if (factor.is_super != 0) {
      const auto* first = static_cast<const Index*>(factor.super);
      const auto* row_begin = static_cast<const Index*>(factor.pi);
      const auto* begin = static_cast<const Index*>(factor.px);
      for (std::size_t s = 0; s < factor.nsuper; ++s) {
        const Index height = row_begin[s + 1] - row_begin[s];
        for (Index j = first[s]; j < first[s + 1]; ++j) {
          const double root = x[begin[s] + (j - first[s]) * (height + 1)];
          pivots_[static_cast<std::size_t>(j)] = root * root;
        }
      }
      return;
    }
    const auto* begin = static_cast<const Index*>(factor.p);
    for (std::size_t k = 0; k < factor.n; ++k) {
      const double diagonal = x[begin[k]];
      pivots_[k] = factor.is_ll != 0 ? diagonal * diagonal : diagonal;
    }
  }

  /// CHOLMOD stops at a pivot that is zero or of the wrong sign; one that is non-zero only by
  /// rounding is detected here.
  void refuse_unfit_pivots() {
    if (kind_ == Kind::kNormal) {
      measure_rows();
      for (std::size_t k = 0; k < pivots_.size(); ++k) {
        const double whole = row_squares_[static_cast<std::size_t>(pivot_rows_[k])];
        if (!(pivots_[k] > kPivotFloor * whole)) {
          refuse_pivot(k, pivots_[k] / whole);
        }
      }
      return;
    }
    for (std::size_t k = 0; k < pivots_.size(); ++k) {
      scaled_pivots_[k] = pivots_[k] / row_scale()[pivot_rows_[k]];
    }
    const int small = find_small_pivot(scaled_pivots_, pivot_rows_);
    if (small < 0) {
      return;
    }
    const auto k = static_cast<std::size_t>(small);
    refuse_pivot(k, scaled_pivots_[k]);
  }

  /// Squared length of each row: the diagonal of A Aᵀ.
  void measure_rows() {
    row_squares_.assign(static_cast<std::size_t>(size()), 0.0);
    const int* rows = matrix().innerIndexPtr();
    for (Eigen::Index k = 0; k < matrix().nonZeros(); ++k) {
      const double value = matrix().valuePtr()[k];
      row_squares_[static_cast<std::size_t>(rows[k])] += value * value;
    }
  }

  [[noreturn]] void refuse_pivot(std::size_t k, double pivot) const {
    const int row = pivot_rows_[k];
    if (kind_ == Kind::kLdlt) {
      throw_singular(row, row, pivot);
    }
    const char* what = "is singular to working precision or not positive definite: ";
    const char* hint =
        "; look for an unknown without stiffness or inertia, or take cholmod_ldlt or klu";
    if (kind_ == Kind::kNormal) {
      what = "is singular to the precision of the normal equations: ";
      hint = "; look for equations that repeat each other, or take spqr or klu";
    }
    throw NumericalFailure(concat(name(), ": factorize: the matrix (", size(), " x ", size(), ") ",
                                  what, "the pivot in ", named("row", row), " is ",
                                  pivot > 0.0 ? concat(pivot) : "not positive", hint));
  }

  void read_info() {
    info_.entries = 2.0 * handle_.common.lnz - size();
    info_.bytes = static_cast<double>(handle_.common.memory_usage);
    info_.flops = flops_ + (kind_ == Kind::kNormal ? handle_.common.aatfl : 0.0);
    if (kind_ == Kind::kNormal) {
      return;  // whose pivots are those of A Aᵀ
    }
    info_.inertia.emplace();
    for (const double pivot : pivots_) {
      ++(pivot > 0.0 ? info_.inertia->positive : info_.inertia->negative);
    }
  }

  void do_solve(System system, MatrixSpan X) override {
    if (X.cols() == 0) {
      return;
    }
    if (kind_ != Kind::kNormal) {
      X = solve_by_factor(X);
    } else if (system == System::kPlain) {
      X.noalias() = matrix().transpose() * solve_by_factor(X);
    } else {
      product_.noalias() = matrix() * X;
      X = solve_by_factor(product_);
    }
  }

  /// @param B  right-hand sides                                          [n x r]
  /// @return   solutions, valid until the next call                      [n x r]
  Eigen::Map<const Eigen::MatrixXd> solve_by_factor(MatrixSpan B) {
    cholmod_dense view = view_of(B);
    const int ok =
        Api<Index>::kSolve(CHOLMOD_A, handle_.factor, &view, nullptr, &handle_.solution, nullptr,
                           &handle_.solve_work, &handle_.row_work, &handle_.common);
    if (ok == 0) {
      throw_status("solve", handle_.common.status);
    }
    return {static_cast<const double*>(handle_.solution->x), B.rows(), B.cols()};
  }

  [[noreturn]] void throw_status(const char* where, int status) const {
    if (status == CHOLMOD_OUT_OF_MEMORY) {
      throw_out_of_memory(where);
    }
    const char* reason = "; its meaning is in cholmod.h";
    if (status == CHOLMOD_TOO_LARGE) {
      reason = " (more entries than the indices can count; take 64-bit indices)";
    } else if (status == CHOLMOD_NOT_INSTALLED) {
      reason = " (this CHOLMOD was built without the ordering or method)";
    }
    throw NumericalFailure(concat(name(), ": ", where, ": status ", status, reason));
  }

  Kind kind_;
  Ordering ordering_;
  Handle<Index> handle_;
  IndexArrays<Index> indices_;
  cholmod_sparse view_ = {};
  double flops_ = 0.0;
  FactorInfo info_;
  std::vector<double> pivots_;
  std::vector<double> scaled_pivots_;
  std::vector<double> row_squares_;
  std::vector<int> pivot_rows_;
  Eigen::MatrixXd product_;
};

std::unique_ptr<LinearSolver> make(Kind kind, const SolverOptions& options) {
  using enum Ordering;
  if (kind == Kind::kNormal) {
    refuse_other_orderings(name_of(kind), options.ordering,
                           {kDefault, kNatural, kAmd, kColamd, kMetis, kNested});
  } else {
    refuse_other_orderings(name_of(kind), options.ordering,
                           {kDefault, kNatural, kAmd, kMetis, kNested});
  }
  if (options.index_width == IndexWidth::k64) {
    return std::make_unique<Cholmod<WideIndex>>(kind, options.ordering);
  }
  return std::make_unique<Cholmod<int>>(kind, options.ordering);
}

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_llt(const SolverOptions& options) {
  return make(Kind::kLlt, options);
}

std::unique_ptr<LinearSolver> make_cholmod_supernodal(const SolverOptions& options) {
  return make(Kind::kSupernodal, options);
}

std::unique_ptr<LinearSolver> make_cholmod_ldlt(const SolverOptions& options) {
  return make(Kind::kLdlt, options);
}

std::unique_ptr<LinearSolver> make_cholmod_normal(const SolverOptions& options) {
  return make(Kind::kNormal, options);
}

}  // namespace hbar::solvers
