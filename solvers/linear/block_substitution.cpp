#include "hbar/solvers/linear/block_substitution.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hbar::solvers {
BlockSubstitution::BlockSubstitution(std::vector<int> block_sizes) {
  if (block_sizes.empty()) {
    throw InvalidInput("block_substitution: no block sizes; expected at least one");
  }
  begin_.reserve(block_sizes.size() + 1);
  begin_.push_back(0);
  for (std::size_t b = 0; b < block_sizes.size(); ++b) {
    if (block_sizes[b] <= 0) {
      throw InvalidInput(concat("block_substitution: block ", b, " has size ", block_sizes[b],
                                "; expected a positive number"));
    }
    begin_.push_back(begin_.back() + block_sizes[b]);
  }
  factors_.resize(block_sizes.size());
  adopted_.assign(block_sizes.size(), 0);
}

FactorInfo BlockSubstitution::factor_info() const {
  FactorInfo info;
  double flops = 0.0;
  for (int b = 0; b < block_count(); ++b) {
    const double n = block_size(b);
    info.entries += n * n;
    flops += 2.0 / 3.0 * n * n * n;
  }
  info.bytes = 8.0 * info.entries + 4.0 * static_cast<double>(below_.size());
  info.flops = flops;
  // Blocks below the diagonal are used as they stand in the matrix.
  for (int j = 0; j < size(); ++j) {
    info.entries += below_block(j).count;
  }
  return info;
}

int BlockSubstitution::block_of(int row) const {
  const auto after = std::upper_bound(begin_.begin(), begin_.end(), row);
  return static_cast<int>(after - begin_.begin()) - 1;
}

void BlockSubstitution::adopt_factors(int block, const BlockFactors& factors) {
  if (block < 0 || block >= block_count()) {
    throw InvalidInput(concat("block_substitution: adopt_factors: there is no block ", block,
                              "; blocks are 0 to ", block_count() - 1));
  }
  if (factors.rows() != block_size(block)) {
    throw InvalidInput(concat("block_substitution: adopt_factors: block ", block, " has size ",
                              block_size(block), ", the factors ", factors.rows()));
  }
  factors_[static_cast<std::size_t>(block)] = factors;
  adopted_[static_cast<std::size_t>(block)] = 1;
}

void BlockSubstitution::do_analyze() {
  const SparseMatrix& A = matrix();
  if (begin_.back() != A.rows()) {
    throw InvalidInput(concat("block_substitution: analyze: the blocks have ", begin_.back(),
                              " rows in all, the matrix has ", A.rows()));
  }
  below_.resize(static_cast<std::size_t>(A.cols()));
  for (int b = 0; b < block_count(); ++b) {
    const int end_row = block_begin(b) + block_size(b);
    for (int j = block_begin(b); j < end_row; ++j) {
      const int* first = A.innerIndexPtr() + A.outerIndexPtr()[j];
      const int* last = A.innerIndexPtr() + A.outerIndexPtr()[j + 1];
      if (first != last && *first < block_begin(b)) {
        throw InvalidInput(concat("block_substitution: analyze: the entry in row ", *first,
                                  ", column ", j, " is above the block diagonal (block row ",
                                  block_of(*first), ", block column ", b,
                                  "); use klu or umfpack for such a matrix"));
      }
      below_[static_cast<std::size_t>(j)] =
          static_cast<int>(std::lower_bound(first, last, end_row) - A.innerIndexPtr());
    }
  }
  panels_.resize(factors_.size());
  diagonals_.resize(factors_.size());
  for (int b = 0; b < block_count(); ++b) {
    panels_[static_cast<std::size_t>(b)] = find_panel(b, true);
    diagonals_[static_cast<std::size_t>(b)] = find_panel(b, false);
  }
}

BlockSubstitution::Panel BlockSubstitution::find_panel(int block, bool below) const {
  const auto part = [&](int j) { return below ? below_block(j) : in_block(j); };
  const int begin = block_begin(block);
  const SparseColumn first = part(begin);
  if (first.count == 0 || first.rows[first.count - 1] - first.rows[0] != first.count - 1) {
    return {};
  }
  const int* outer = matrix().outerIndexPtr();
  for (int j = begin + 1; j < begin + block_size(block); ++j) {
    const SparseColumn column = part(j);
    // Columns of equal length lie one stride apart.
    if (column.count != first.count || column.rows[0] != first.rows[0] ||
        column.rows[column.count - 1] != first.rows[first.count - 1] ||
        outer[j + 1] - outer[j] != outer[begin + 1] - outer[begin]) {
      return {};
    }
  }
  return {first.rows[0], first.count};
}

BlockSubstitution::DenseView BlockSubstitution::dense_view(int block, const Panel& panel,
                                                           const double* first_value) const {
  const int* outer = matrix().outerIndexPtr() + block_begin(block);
  return {first_value, panel.rows, block_size(block), Eigen::OuterStride<>(outer[1] - outer[0])};
}

void BlockSubstitution::do_factorize() {
  for (int b = 0; b < block_count(); ++b) {
    factorize_block(b);
  }
  std::fill(adopted_.begin(), adopted_.end(), 0);
}

void BlockSubstitution::factorize_block(int block) {
  const SparseMatrix& A = matrix();
  const auto b = static_cast<std::size_t>(block);
  const int first = block_begin(block);
  const int size = block_size(block);
  block_.setZero(size, size);
  for (int j = 0; j < size; ++j) {
    const int end = below_[static_cast<std::size_t>(first + j)];
    for (int k = A.outerIndexPtr()[first + j]; k < end; ++k) {
      block_(A.innerIndexPtr()[k] - first, j) = A.valuePtr()[k];
    }
  }
  if (adopted_[b] == 0) {
    factors_[b].compute(block_);
  }
  const auto& lu = factors_[b].matrixLU();
  for (int j = 0; j < size; ++j) {
    const double pivot = lu(j, j);
    // Written so that NaN pivots are found too.
    if (std::abs(pivot) > kPivotFloor * block_.col(j).lpNorm<Eigen::Infinity>()) {
      continue;
    }
    const auto& destination = factors_[b].permutationP().indices();
    const auto row = std::find(destination.begin(), destination.end(), j) - destination.begin();
    throw NumericalFailure(
        concat("block_substitution: factorize: diagonal block ", block, " of ", block_count(), " (",
               size, " x ", size, ") is singular to working precision: the pivot in ",
               named("row", first + static_cast<int>(row)), ", ", named("column", first + j),
               " is ", pivot,
               "; look for an unknown without stiffness or inertia, or for equations that repeat "
               "each other"));
  }
}

void BlockSubstitution::do_solve(System system, MatrixSpan X) { substitute(system, X, nullptr); }

bool BlockSubstitution::do_solve_with_residuals(System system, MatrixSpan X, Eigen::MatrixXd& R) {
  R.resize(X.rows(), X.cols());
  substitute(system, X, &R);
  return true;
}

SparseColumn BlockSubstitution::below_block(int column) const {
  const int begin = below_[static_cast<std::size_t>(column)];
  return {matrix().innerIndexPtr() + begin, matrix().valuePtr() + begin,
          matrix().outerIndexPtr()[column + 1] - begin};
}

SparseColumn BlockSubstitution::in_block(int column) const {
  const int begin = matrix().outerIndexPtr()[column];
  return {matrix().innerIndexPtr() + begin, matrix().valuePtr() + begin,
          below_[static_cast<std::size_t>(column)] - begin};
}

/// Each diagonal block is solved with its row's right-hand side minus the known part; what remains
/// is the row's residual.
void BlockSubstitution::substitute(System system, MatrixSpan X, Eigen::MatrixXd* R) {
  const bool forward = system == System::kPlain;
  for (int i = 0; i < block_count(); ++i) {
    const int b = forward ? i : block_count() - 1 - i;
    if (!forward) {
      gather_below(b, X);
    }
    auto X_b = X.middleRows(block_begin(b), block_size(b));
    if ((X_b.array() == 0.0).all()) {
      if (R != nullptr) {
        R->middleRows(block_begin(b), block_size(b)).setZero();
      }
      continue;
    }
    if (R != nullptr) {
      R->middleRows(block_begin(b), block_size(b)) = X_b;
    }
    solve_block(b, system, X_b);
    if (R != nullptr) {
      subtract_diagonal(b, system, X_b, R->middleRows(block_begin(b), block_size(b)));
    }
    if (forward) {
      subtract_below(b, X);
    }
  }
}

/// x ← A_b⁻¹ x or A_b⁻ᵀ x.
void BlockSubstitution::solve_block(int block, System system, MatrixSpan X_b) {
  const BlockFactors& factors = factors_[static_cast<std::size_t>(block)];
  const auto& lu = factors.matrixLU();
  const auto& destination = factors.permutationP().indices();
  const int size = block_size(block);
  work_.resize(size, 1);
  auto y = work_.col(0);
  for (Eigen::Index r = 0; r < X_b.cols(); ++r) {
    auto x = X_b.col(r);
    if (system == System::kPlain) {
      for (int i = 0; i < size; ++i) {
        y[destination[i]] = x[i];
      }
      lu.triangularView<Eigen::UnitLower>().solveInPlace(y);
      lu.triangularView<Eigen::Upper>().solveInPlace(y);
      x = y;
    } else {
      y = x;
      lu.transpose().triangularView<Eigen::Lower>().solveInPlace(y);
      lu.transpose().triangularView<Eigen::UnitUpper>().solveInPlace(y);
      for (int i = 0; i < size; ++i) {
        x[i] = y[destination[i]];
      }
    }
  }
}

/// r ← r − A_b x or r − A_bᵀ x.
void BlockSubstitution::subtract_diagonal(int block, System system, const MatrixView& X_b,
                                          MatrixSpan R_b) const {
  const Panel& dense = diagonals_[static_cast<std::size_t>(block)];
  const int first = block_begin(block);
  if (dense.rows == block_size(block)) {
    const DenseView A = dense_view(block, dense, in_block(first).values);
    if (system == System::kPlain) {
      R_b.noalias() -= A * X_b;
    } else {
      R_b.noalias() -= A.transpose() * X_b;
    }
    return;
  }
  for (Eigen::Index r = 0; r < X_b.cols(); ++r) {
    // Entries hold rows of the whole matrix: those of the block begin at `first`.
    double* residual = R_b.col(r).data() - first;
    const double* x = X_b.col(r).data() - first;
    for (int j = first; j < first + block_size(block); ++j) {
      if (system == System::kPlain) {
        in_block(j).subtract_from(residual, x[j]);
      } else {
        residual[j] -= in_block(j).dot(x);
      }
    }
  }
}

/// Subtracts the contribution of a solved block from the right-hand sides of the rows below it.
void BlockSubstitution::subtract_below(int block, MatrixSpan X) const {
  const Panel& dense = panels_[static_cast<std::size_t>(block)];
  const int first = block_begin(block);
  if (dense.rows > 0) {
    X.middleRows(dense.first_row, dense.rows).noalias() -=
        dense_view(block, dense, below_block(first).values) *
        X.middleRows(first, block_size(block));
    return;
  }
  for (Eigen::Index r = 0; r < X.cols(); ++r) {
    double* x = X.col(r).data();
    for (int j = first; j < first + block_size(block); ++j) {
      below_block(j).subtract_from(x, x[j]);
    }
  }
}

/// Subtracts the contribution of the solved rows below, in the transposed system, from a block's
/// right-hand side.
void BlockSubstitution::gather_below(int block, MatrixSpan X) const {
  const Panel& dense = panels_[static_cast<std::size_t>(block)];
  const int first = block_begin(block);
  if (dense.rows > 0) {
    X.middleRows(first, block_size(block)).noalias() -=
        dense_view(block, dense, below_block(first).values).transpose() *
        X.middleRows(dense.first_row, dense.rows);
    return;
  }
  for (Eigen::Index r = 0; r < X.cols(); ++r) {
    double* x = X.col(r).data();
    for (int j = first; j < first + block_size(block); ++j) {
      x[j] -= below_block(j).dot(x);
    }
  }
}

std::unique_ptr<LinearSolver> make_block_substitution(std::vector<int> block_sizes) {
  return std::make_unique<BlockSubstitution>(std::move(block_sizes));
}

}  // namespace hbar::solvers
