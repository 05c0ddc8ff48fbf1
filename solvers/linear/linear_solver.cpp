#include "hbar/solvers/linear/linear_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hbar/solvers/linear/sparse_column.h"

namespace hbar::solvers {
namespace {

/// Whether every entry (i, j) has its (j, i).
bool has_symmetric_pattern(const SparseMatrix& A) {
  const SparseMatrix transposed = A.transpose();
  return std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1,
                    transposed.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(),
                    transposed.innerIndexPtr());
}

bool same_pattern(const SparseMatrix& A, const SparseMatrix& B) {
  if (A.rows() != B.rows() || A.cols() != B.cols() || !A.isCompressed()) {
    return false;
  }
  return A.nonZeros() == B.nonZeros() &&
         std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), B.innerIndexPtr());
}

SparseColumn whole_column(const SparseMatrix& A, int j) {
  const int begin = A.outerIndexPtr()[j];
  return {A.innerIndexPtr() + begin, A.valuePtr() + begin, A.outerIndexPtr()[j + 1] - begin};
}

const char* symbol(System system) { return system == System::kPlain ? "A x = b" : "A^T x = b"; }

}  // namespace

void LinearSolver::refuse_unusable_pattern(const SparseMatrix& A) const {
  const std::string where = concat(name(), ": analyze: ");
  if (A.rows() != A.cols() || A.rows() == 0) {
    throw InvalidInput(concat(where, "the matrix is ", A.rows(), " x ", A.cols(),
                              "; expected a square one with at least one row"));
  }
  if (!A.isCompressed()) {
    throw InvalidInput(concat(where, "the matrix is not compressed; call makeCompressed() first"));
  }
  std::vector<char> row_has_entry(static_cast<std::size_t>(A.rows()), 0);
  const int* rows = A.innerIndexPtr();
  for (int j = 0; j < A.cols(); ++j) {
    const int begin = A.outerIndexPtr()[j];
    const int end = A.outerIndexPtr()[j + 1];
    for (int k = begin; k < end; ++k) {
      if (rows[k] < 0 || rows[k] >= A.rows() || (k > begin && rows[k] <= rows[k - 1])) {
        throw InvalidInput(concat(where, "entry ", k - begin, " of column ", j, " is in row ",
                                  rows[k], "; expected ascending rows from 0 to ", A.rows() - 1));
      }
      row_has_entry[static_cast<std::size_t>(rows[k])] = 1;
    }
    if (begin == end) {
      throw NumericalFailure(concat(where, "the matrix is singular: ", named("column", j),
                                    " has no entry; look for an unknown that no equation uses"));
    }
  }
  const auto empty = std::find(row_has_entry.begin(), row_has_entry.end(), 0);
  if (empty != row_has_entry.end()) {
    throw NumericalFailure(concat(where, "the matrix is singular: ",
                                  named("row", static_cast<int>(empty - row_has_entry.begin())),
                                  " has no entry; look for an equation without unknowns"));
  }
  if (needs_symmetry() && !has_symmetric_pattern(A)) {
    throw InvalidInput(concat(where, "the pattern is not symmetric; use umfpack or klu for such a ",
                              "matrix, or store both triangles of a symmetric one"));
  }
}

void LinearSolver::analyze(const SparseMatrix& A) {
  refuse_unusable_pattern(A);
  analyzed_ = false;
  factorized_ = false;
  matrix_ = A;
  row_scale_.setZero(A.rows());
  row_sum_.setZero(A.rows());
  column_max_.setZero(A.cols());
  residual_.setZero(A.rows());
  refined_.setZero(A.rows());
  do_analyze();
  ++statistics_.analyses;
  analyzed_ = true;
}

void LinearSolver::factorize(const SparseMatrix& A) {
  if (!analyzed_) {
    throw InvalidInput(concat(name(), ": factorize: no pattern was analysed; call analyze first"));
  }
  if (!same_pattern(A, matrix_)) {
    throw InvalidInput(concat(name(), ": factorize: the matrix (", A.rows(), " x ", A.cols(), ", ",
                              A.nonZeros(), " entries) has another pattern than the one analysed (",
                              matrix_.rows(), " x ", matrix_.cols(), ", ", matrix_.nonZeros(),
                              " entries); call analyze again"));
  }
  factorized_ = false;
  std::copy(A.valuePtr(), A.valuePtr() + A.nonZeros(), matrix_.valuePtr());
  measure_matrix();
  do_factorize();
  ++statistics_.factorizations;
  factorized_ = true;
}

/// Norms and scales of matrix_; refuses entries that are not finite.
void LinearSolver::measure_matrix() {
  row_scale_.setZero();
  row_sum_.setZero();
  norm_one_ = 0.0;
  for (int j = 0; j < matrix_.cols(); ++j) {
    const double column_sum = whole_column(matrix_, j).measure(row_scale_.data(), row_sum_.data());
    if (!std::isfinite(column_sum)) {
      throw_not_finite(j);
    }
    norm_one_ = std::max(norm_one_, column_sum);
  }
  norm_inf_ = row_sum_.maxCoeff();
}

/// Names the entry of a column that is not finite; returns if there is none (their sum overflowed).
void LinearSolver::throw_not_finite(int column) const {
  for (SparseMatrix::InnerIterator it(matrix_, column); it; ++it) {
    if (std::isfinite(it.value())) {
      continue;
    }
    throw NumericalFailure(concat(name(), ": factorize: the entry in ",
                                  named("row", static_cast<int>(it.row())), ", ",
                                  named("column", column), " is ", it.value(),
                                  "; check the state the matrix was computed at"));
  }
}

/// Largest magnitude of each column of the row-scaled matrix.
void LinearSolver::measure_columns() {
  const int* begin = matrix_.outerIndexPtr();
  const int* rows = matrix_.innerIndexPtr();
  const double* values = matrix_.valuePtr();
  for (int j = 0; j < matrix_.cols(); ++j) {
    double largest = 0.0;
    for (int k = begin[j]; k < begin[j + 1]; ++k) {
      const double scale = row_scale_[rows[k]];
      if (scale > 0.0) {
        largest = std::max(largest, std::abs(values[k]) / scale);
      }
    }
    column_max_[j] = largest;
  }
}

int LinearSolver::find_small_pivot(std::span<const double> pivots, std::span<const int> columns) {
  measure_columns();
  for (std::size_t k = 0; k < pivots.size(); ++k) {
    // Written so that NaN pivots are found too.
    if (!(std::abs(pivots[k]) > kPivotFloor * column_max_[columns[k]])) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

std::string LinearSolver::named(const char* kind, int index) const {
  return name_of_ ? concat(kind, ' ', index, " (", name_of_(index), ')') : concat(kind, ' ', index);
}

void LinearSolver::throw_singular(int row, int column, double pivot) const {
  throw NumericalFailure(concat(name(), ": factorize: the matrix (", matrix_.rows(), " x ",
                                matrix_.cols(), ") is singular to working precision: the pivot in ",
                                named("row", row), ", ", named("column", column), " is ", pivot,
                                "; look for an unknown without stiffness or inertia, or for ",
                                "equations that repeat each other"));
}

void LinearSolver::throw_out_of_memory(const char* phase) const {
  throw OutOfMemory(concat(name(), ": ", phase, ": out of memory (", matrix_.rows(), " x ",
                           matrix_.cols(), " matrix with ", matrix_.nonZeros(),
                           " entries); take fewer steps, another ordering, or for a block ",
                           "triangular matrix block_substitution, which has no fill"));
}

void LinearSolver::solve(const MatrixView& B, MatrixSpan X) { solve(System::kPlain, B, X); }

void LinearSolver::solve_transposed(const MatrixView& B, MatrixSpan X) {
  solve(System::kTransposed, B, X);
}

void LinearSolver::solve(System system, const MatrixView& B, MatrixSpan X) {
  if (!factorized_) {
    throw InvalidInput(concat(name(), ": solve: no matrix is factorised; call factorize first"));
  }
  if (B.rows() != matrix_.rows() || X.rows() != B.rows() || X.cols() != B.cols()) {
    throw InvalidInput(concat(name(), ": solve: the right-hand sides are ", B.rows(), " x ",
                              B.cols(), " and the solutions ", X.rows(), " x ", X.cols(),
                              "; expected ", matrix_.rows(), " rows and equal shapes"));
  }
  if (!B.allFinite()) {
    for (Eigen::Index j = 0; j < B.cols(); ++j) {
      for (Eigen::Index i = 0; i < B.rows(); ++i) {
        if (std::isfinite(B(i, j))) {
          continue;
        }
        throw NumericalFailure(concat(name(), ": solve: row ", i, " of right-hand side ", j, " is ",
                                      B(i, j), "; check what it was computed from"));
      }
    }
  }
  if (X.data() == B.data() && X.size() > 0) {
    kept_rhs_ = B;
    solve_and_check(system, kept_rhs_, X);
  } else {
    solve_and_check(system, B, X);
  }
  statistics_.solves += static_cast<int>(B.cols());
}

/// Solves, with other factors if need be, and refuses a solution that is wrong.
void LinearSolver::solve_and_check(System system, const MatrixView& B, MatrixSpan X) {
  Refusal refusal = solve_and_refine(system, B, X);
  if (refusal.column >= 0 && do_factorize_strictly()) {
    ++statistics_.factorizations;
    refusal = solve_and_refine(system, B, X);
  }
  if (refusal.column >= 0) {
    throw NumericalFailure(concat(
        name(), ": the scaled residual of ", symbol(system), ", right-hand side ", refusal.column,
        ", is ", refusal.residual, " after refinement; allowed: ", bounds_.refuse_above, " (",
        matrix_.rows(), " x ", matrix_.cols(),
        " matrix); try another solver, or bring the unknowns to similar sizes"));
  }
}

void LinearSolver::solve_in_place(System system, MatrixSpan X) {
  has_residuals_ = do_solve_with_residuals(system, X, residuals_);
  if (!has_residuals_) {
    do_solve(system, X);
  }
}

/// Leaves b − A x in residual_, and returns it scaled; NaN if x is not finite.
double LinearSolver::scaled_residual(System system, const VectorView<double>& b,
                                     const VectorView<double>& x) {
  residual_ = b;
  for (int j = 0; j < matrix_.cols(); ++j) {
    const SparseColumn column = whole_column(matrix_, j);
    if (system == System::kTransposed) {
      residual_[j] -= column.dot(x.data());
    } else if (x[j] != 0.0) {
      column.subtract_from(residual_.data(), x[j]);
    }
  }
  return scaled(system, residual_, b, x);
}

double LinearSolver::scaled(System system, const VectorView<double>& residual,
                            const VectorView<double>& b, const VectorView<double>& x) const {
  if (!x.allFinite()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double norm = system == System::kPlain ? norm_inf_ : norm_one_;
  const double size = norm * x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>();
  return size > 0.0 ? residual.lpNorm<Eigen::Infinity>() / size : 0.0;
}

/// Solves and refines what needs it; returns the first solution that is wrong nevertheless.
LinearSolver::Refusal LinearSolver::solve_and_refine(System system, const MatrixView& B,
                                                     MatrixSpan X) {
  X = B;
  solve_in_place(system, X);
  for (Eigen::Index j = 0; j < B.cols(); ++j) {
    double residual = has_residuals_ ? scaled(system, residuals_.col(j), B.col(j), X.col(j))
                                     : scaled_residual(system, B.col(j), X.col(j));
    if (residual > bounds_.refine_above) {
      ++statistics_.refinements;
      if (has_residuals_) {
        residual_ = residuals_.col(j);
      }
    }
    for (int i = 0; i < bounds_.max_refinements && residual > bounds_.refine_above; ++i) {
      do_solve(system, residual_);
      refined_ = X.col(j) + residual_;
      const double before = residual;
      const double after = scaled_residual(system, B.col(j), refined_);
      if (after < before) {
        X.col(j) = refined_;
        residual = after;
      }
      if (!(after < 0.5 * before)) {
        break;
      }
    }
    if (!(residual <= bounds_.refuse_above)) {
      return {.column = j, .residual = residual};
    }
    statistics_.worst_residual = std::max(statistics_.worst_residual, residual);
  }
  return {};
}

void LinearSolver::set_residual_bounds(const ResidualBounds& bounds) {
  if (!(bounds.refine_above >= 0.0) || !(bounds.refuse_above > 0.0) || bounds.max_refinements < 0) {
    throw InvalidInput(concat(name(), ": residual bounds: refine_above is ", bounds.refine_above,
                              ", refuse_above ", bounds.refuse_above, " and max_refinements ",
                              bounds.max_refinements,
                              "; expected 0 or more, more than 0, and 0 or more"));
  }
  bounds_ = bounds;
}

}  // namespace hbar::solvers
