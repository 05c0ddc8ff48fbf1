#include "hbar/solvers/block_substitution.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hbar::solvers {
namespace {

/// x ← A_b⁻¹ x or A_b⁻ᵀ x; one column takes Eigen's faster path for vectors.
void solve_block(const BlockFactors& factors, System system, MatrixSpan X_b) {
  const auto solve_in_place = [&](auto X) {
    if (system == System::kPlain) {
      X = factors.solve(X);
    } else {
      X = factors.transpose().solve(X);
    }
  };
  if (X_b.cols() == 1) {
    solve_in_place(X_b.col(0));
  } else {
    solve_in_place(X_b);
  }
}

}  // namespace

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
  for (int j = 0; j < size(); ++j) info.entries += below_block(j).count;
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
}

void BlockSubstitution::do_factorize() {
  for (int b = 0; b < block_count(); ++b) factorize_block(b);
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
  if (adopted_[b] == 0) factors_[b].compute(block_);
  const auto& lu = factors_[b].matrixLU();
  for (int j = 0; j < size; ++j) {
    const double pivot = lu(j, j);
    // Written so that a pivot that is not a number is found, too.
    if (std::abs(pivot) > kPivotFloor * block_.col(j).lpNorm<Eigen::Infinity>()) continue;
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

void BlockSubstitution::do_solve(System system, MatrixSpan X) {
  if (system == System::kPlain) {
    substitute_forward(X);
  } else {
    substitute_backward(X);
  }
}

SparseColumn BlockSubstitution::below_block(int column) const {
  const int begin = below_[static_cast<std::size_t>(column)];
  return {matrix().innerIndexPtr() + begin, matrix().valuePtr() + begin,
          matrix().outerIndexPtr()[column + 1] - begin};
}

void BlockSubstitution::substitute_forward(MatrixSpan X) const {
  for (int b = 0; b < block_count(); ++b) {
    const int first = block_begin(b);
    const int size = block_size(b);
    auto X_b = X.middleRows(first, size);
    if ((X_b.array() == 0.0).all()) continue;
    solve_block(factors_[static_cast<std::size_t>(b)], System::kPlain, X_b);
    for (Eigen::Index r = 0; r < X.cols(); ++r) {
      double* x = X.col(r).data();
      for (int j = first; j < first + size; ++j) below_block(j).subtract_from(x, x[j]);
    }
  }
}

void BlockSubstitution::substitute_backward(MatrixSpan X) const {
  for (int b = block_count() - 1; b >= 0; --b) {
    const int first = block_begin(b);
    const int size = block_size(b);
    for (Eigen::Index r = 0; r < X.cols(); ++r) {
      double* x = X.col(r).data();
      for (int j = first; j < first + size; ++j) x[j] -= below_block(j).dot(x);
    }
    auto X_b = X.middleRows(first, size);
    if ((X_b.array() == 0.0).all()) continue;
    solve_block(factors_[static_cast<std::size_t>(b)], System::kTransposed, X_b);
  }
}

std::unique_ptr<LinearSolver> make_block_substitution(std::vector<int> block_sizes) {
  return std::make_unique<BlockSubstitution>(std::move(block_sizes));
}

}  // namespace hbar::solvers
