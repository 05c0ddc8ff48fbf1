#include "hbar/solvers/linear/eigen_sparse_lu.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <new>

#include "hbar/solvers/linear/row_scaling.h"

namespace hbar::solvers {
namespace {

template <typename Index>
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index>;

/// The order as it is. Eigen's own returns no permutation at all, and then the elimination tree is
/// renumbered in postorder but the columns are not.
template <typename Index>
struct Natural {
  using PermutationType = Permutation<Index>;
  template <typename Matrix>
  void operator()(const Matrix& A, PermutationType& place) const {
    place.setIdentity(A.cols());
  }
};

/// Eigen's minimum degree names the column that comes at each place; SparseLU wants the place of
/// each column, and fills in like a random order if it is given the former.
template <typename Index>
struct Amd {
  using PermutationType = Permutation<Index>;
  template <typename Matrix>
  void operator()(const Matrix& A, PermutationType& place) const {
    PermutationType column;
    Eigen::AMDOrdering<Index>()(A, column);
    place = column.inverse();
  }
};

/// Eigen's factors, and what they tell about singular matrices.
template <typename Order, typename Index>
class Factors final : public Eigen::SparseLU<Eigen::SparseMatrix<double, 0, Index>, Order> {
 public:
  [[nodiscard]] bool is_complete() const { return this->m_factorizationIsOk; }
  /// Columns eliminated before the factorisation came to its end.
  [[nodiscard]] Eigen::Index eliminated() const { return this->m_perm_r.indices().maxCoeff() + 1; }
  /// Diagonal entry of U in a column of the factors.
  [[nodiscard]] double pivot(Eigen::Index column) const {
    using Store = typename Factors::SCMatrix;
    for (typename Store::InnerIterator entry(this->m_Lstore, column); entry; ++entry) {
      if (entry.index() == column) {
        return entry.value();
      }
    }
    return 0.0;
  }
};

template <template <typename> class Order, typename Index>
class EigenSparseLu final : public LinearSolver {
 public:
  [[nodiscard]] std::string name() const override { return "eigen_sparse_lu"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    if (!factorized_) {
      return {};
    }
    const double stored = static_cast<double>(lu_.nnzL() + lu_.nnzU());
    const double copies = 2.0 * static_cast<double>(scaled_.nonZeros());
    return {.entries = stored - size(),
            .bytes = (stored + copies) * static_cast<double>(sizeof(double) + sizeof(Index)),
            .flops = {},
            .inertia = {}};
  }

 private:
  void do_analyze() override {
    try {
      scaled_ = matrix();
      scale_.resize(size());
      lu_.analyzePattern(scaled_);
      pivots_.resize(static_cast<std::size_t>(size()));
      pivot_columns_.resize(static_cast<std::size_t>(size()));
    } catch (const std::bad_alloc&) {
      throw_out_of_memory("analyze");
    }
  }

  void do_factorize() override {
    factorized_ = false;
    scale_rows();
    try {
      lu_.factorize(scaled_);
    } catch (const std::bad_alloc&) {
      throw_out_of_memory("factorize");
    }
    const auto& row_place = lu_.rowsPermutation().indices();
    const auto& column_place = lu_.colsPermutation().indices();
    if (!lu_.is_complete()) {
      // Only a column of zeros or lack of memory ends it early.
      if (lu_.lastErrorMessage().find("SINGULAR") == std::string::npos) {
        throw_out_of_memory("factorize");
      }
      const Eigen::Index place = lu_.eliminated() - 1;
      throw_singular(at_place(row_place, place), at_place(column_place, place), 0.0);
    }
    for (int j = 0; j < size(); ++j) {
      const auto place = static_cast<std::size_t>(column_place[j]);
      pivots_[place] = lu_.pivot(column_place[j]);
      pivot_columns_[place] = j;
    }
    const int small = find_small_pivot(pivots_, pivot_columns_);
    if (small >= 0) {
      const auto k = static_cast<std::size_t>(small);
      throw_singular(at_place(row_place, small), pivot_columns_[k], pivots_[k]);
    }
    factorized_ = true;
  }

  void do_solve(System system, MatrixSpan X) override {
    if (X.cols() == 0) {
      return;
    }
    try {
      // Eigen's substitutions take columns to be contiguous to each other, which those of X need
      // not be.
      if (system == System::kPlain) {
        const Eigen::MatrixXd scaled = scale_.asDiagonal() * X;
        const Eigen::MatrixXd solutions = lu_.solve(scaled);
        X = solutions;
      } else {
        const Eigen::MatrixXd solutions = lu_.transpose().solve(X);
        X = scale_.asDiagonal() * solutions;
      }
    } catch (const std::bad_alloc&) {
      throw_out_of_memory("solve");
    }
  }

  void scale_rows() {
    set_power_of_two_scales(row_scale(), scale_);
    for (Eigen::Index k = 0; k < matrix().nonZeros(); ++k) {
      scaled_.valuePtr()[k] = matrix().valuePtr()[k] * scale_[matrix().innerIndexPtr()[k]];
    }
  }

  template <typename Places>
  [[nodiscard]] static int at_place(const Places& places, Eigen::Index place) {
    return static_cast<int>(
        std::find(places.data(), places.data() + places.size(), static_cast<Index>(place)) -
        places.data());
  }

  Factors<Order<Index>, Index> lu_;
  Eigen::SparseMatrix<double, 0, Index> scaled_;
  Eigen::VectorXd scale_;  // rows are multiplied by this
  std::vector<double> pivots_;
  std::vector<int> pivot_columns_;
  bool factorized_ = false;
};

template <template <typename> class Order>
std::unique_ptr<LinearSolver> make(IndexWidth width) {
  if (width == IndexWidth::k64) {
    return std::make_unique<EigenSparseLu<Order, Eigen::Index>>();
  }
  return std::make_unique<EigenSparseLu<Order, int>>();
}

}  // namespace

std::unique_ptr<LinearSolver> make_eigen_sparse_lu(const SolverOptions& options) {
  using enum Ordering;
  refuse_other_orderings("eigen_sparse_lu", options.ordering, {kDefault, kNatural, kAmd, kColamd});
  if (options.ordering == kNatural) {
    return make<Natural>(options.index_width);
  }
  if (options.ordering == kAmd) {
    return make<Amd>(options.index_width);
  }
  return make<Eigen::COLAMDOrdering>(options.index_width);
}

}  // namespace hbar::solvers
