#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/base/scalar.h"

namespace hbar::solvers {

/// Compressed sparse columns, row indices ascending within a column.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
/// One or several right-hand sides, a column each; a vector is a matrix of one column.
using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;
/// Like MatrixView, but writable.
using MatrixSpan = Eigen::Ref<Eigen::MatrixXd>;

/// Which system is solved.
enum class System {
  kPlain,       ///< A X = B
  kTransposed,  ///< Aᵀ X = B
};

/// When a solution is refined and when it is refused, in terms of the scaled residual
/// ‖b − A x‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞).
struct ResidualBounds {
  double refine_above =
      1e-14;  ///< iterative refinement above this, as long as it halves the residual
  double refuse_above = 1e-10;  ///< NumericalFailure if it is still above this
  int max_refinements = 3;      ///< steps of refinement per right-hand side
};

/// Signs of a symmetric matrix's eigenvalues.
struct Inertia {
  int positive = 0;
  int negative = 0;
  int zero = 0;
  friend bool operator==(const Inertia&, const Inertia&) = default;
};

/// Figures of the last factorisation.
struct FactorInfo {
  /// Entries of both factors, their diagonal counted once: those of L + U, of L + Lᵀ where one
  /// triangle is kept, of R and the reflections of a QR factorisation. Dense blocks and bands count
  /// whole.
  double entries = 0.0;
  double bytes = 0.0;           ///< of factors, analysis and workspace, approximate
  std::optional<double> flops;  ///< operations of the factorisation, where the solver counts them
  std::optional<Inertia> inertia;  ///< if the factorisation reveals it
};

/// A solver could not get the memory it asked for; the message says which solver and what to try.
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(const std::string& message) : error_(message) {}
  [[nodiscard]] const char* what() const noexcept override { return error_.what(); }

 private:
  Error error_;  // for its string, which copies without throwing
};

/// What a solver has done since it was made.
struct SolverStatistics {
  int analyses = 0;             ///< symbolic analyses
  int factorizations = 0;       ///< numeric factorisations, refactorisations included
  int refactorizations = 0;     ///< of these, those that kept the earlier pivot order
  int solves = 0;               ///< right-hand sides solved
  int refinements = 0;          ///< right-hand sides that needed refinement
  double worst_residual = 0.0;  ///< largest scaled residual that was accepted
};

/// Solves A X = B and Aᵀ X = B for a sparse square A: analyse a pattern once, factorise whenever
/// its values change, solve any number of times.
///
/// Every solution is checked: the residual of each right-hand side is computed with the matrix as
/// given; the solution is refined where that helps, and refused if the residual stays too large. An
/// object holds its workspace and belongs to one thread at a time; different objects are
/// independent.
class LinearSolver {
 public:
  LinearSolver() = default;
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;
  virtual ~LinearSolver() = default;

  /// The name that solver_factory knows, for messages: "block_substitution", "klu", "umfpack".
  [[nodiscard]] virtual std::string name() const = 0;
  /// Figures of the last factorisation; meaningless before the first.
  [[nodiscard]] virtual FactorInfo factor_info() const = 0;

  /// Sets what a row (and the column of the same index) stands for; messages then name it.
  ///
  /// @param name_of  from an index, 0 ≤ index < n, to "stage 3, coordinate elbow" or the like
  void name_unknowns(std::function<std::string(int)> name_of) { name_of_ = std::move(name_of); }

  /// Analyses the pattern of A; its values are not read.
  ///
  /// @param A  square, compressed, row indices ascending  [n x n]
  /// @throws InvalidInput if A is not such a matrix, or its pattern is not symmetric although the
  ///         solver needs that
  /// @throws NumericalFailure naming a row or column without entries
  /// @throws OutOfMemory
  void analyze(const SparseMatrix& A);

  /// Factorises the values of A, and keeps a copy of them for the residual.
  ///
  /// @param A  of the pattern last analysed  [n x n]
  /// @throws InvalidInput if the pattern differs, or none was analysed
  /// @throws NumericalFailure if an entry is not finite, or A is singular to working precision (a
  ///   pivot below 1e-14 of its column, rows scaled to 1): the message names row and column, and
  ///   what they stand for; or if a symmetric solver finds that A is not of its kind
  /// @throws OutOfMemory
  void factorize(const SparseMatrix& A);

  /// Solves A X = B.
  ///
  /// @param B  right-hand sides                                  [n x r]
  /// @param X  solutions; may be the same memory as B            [n x r]
  /// @throws InvalidInput if the shapes disagree or nothing is factorised
  /// @throws NumericalFailure if B or X is not finite, or a residual is too large
  void solve(const MatrixView& B, MatrixSpan X);

  /// Solves Aᵀ X = B; otherwise like solve().
  ///
  /// @param B  right-hand sides                                  [n x r]
  /// @param X  solutions; may be the same memory as B            [n x r]
  void solve_transposed(const MatrixView& B, MatrixSpan X);

  /// Solves A X = B or Aᵀ X = B; otherwise like solve().
  ///
  /// @param B  right-hand sides                                  [n x r]
  /// @param X  solutions; may be the same memory as B            [n x r]
  void solve(System system, const MatrixView& B, MatrixSpan X);

  /// Number of rows of the analysed pattern; 0 before the first analysis.
  [[nodiscard]] int size() const { return static_cast<int>(matrix_.rows()); }
  [[nodiscard]] const SolverStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const ResidualBounds& residual_bounds() const { return bounds_; }
  /// @throws InvalidInput unless 0 ≤ refine_above, 0 < refuse_above and 0 ≤ max_refinements
  void set_residual_bounds(const ResidualBounds& bounds);

 protected:
  /// Whether only matrices of symmetric pattern are accepted; their values are then assumed
  /// symmetric too, and only one triangle may be read.
  [[nodiscard]] virtual bool needs_symmetry() const { return false; }
  /// Analyses matrix().
  virtual void do_analyze() = 0;
  /// Factorises matrix(), whose values are finite. Reports a singular matrix by find_small_pivot
  /// and throw_singular, or in another way.
  virtual void do_factorize() = 0;
  /// Factorises matrix() again with pivots chosen more strictly, for a solution that is too
  /// inaccurate although the matrix is not singular; false if there is no stricter choice.
  virtual bool do_factorize_strictly() { return false; }
  /// Overwrites right-hand sides by solutions.
  ///
  /// @param X  finite; columns contiguous  [n x r]
  virtual void do_solve(System system, MatrixSpan X) = 0;
  /// The same, and leaves the residuals B − A X (or B − Aᵀ X), for solvers that obtain them while
  /// solving; others return false and leave X unchanged.
  ///
  /// @param X  as in do_solve  [n x r]
  /// @param R  residuals, resized  [n x r]
  virtual bool do_solve_with_residuals(System /*system*/, MatrixSpan /*X*/,
                                       Eigen::MatrixXd& /*R*/) {
    return false;
  }

  /// The matrix last analysed, with the values last factorised  [n x n]
  [[nodiscard]] const SparseMatrix& matrix() const { return matrix_; }
  /// Largest magnitude of each row of matrix(), by which rows are divided when judging pivots  [n]
  [[nodiscard]] const Eigen::VectorXd& row_scale() const { return row_scale_; }

  /// The first pivot that is too small relative to its column of the row-scaled matrix; -1: none.
  ///
  /// @param pivots   of the row-scaled matrix               [n]
  /// @param columns  column of A of each pivot, from 0      [n]
  [[nodiscard]] int find_small_pivot(std::span<const double> pivots, std::span<const int> columns);

  /// Throws the NumericalFailure of a singular matrix.
  ///
  /// @param row     row of A of the pivot
  /// @param column  column of A of the pivot
  /// @param pivot   of the row-scaled matrix
  [[noreturn]] void throw_singular(int row, int column, double pivot) const;

  /// Throws OutOfMemory.
  ///
  /// @param phase  "analyze", "factorize" or "solve"
  [[noreturn]] void throw_out_of_memory(const char* phase) const;

  /// "row 12", or "row 12 (stage 3, coordinate elbow)" where unknowns have names.
  ///
  /// @param kind  "row" or "column"
  [[nodiscard]] std::string named(const char* kind, int index) const;

  void count_refactorization() { ++statistics_.refactorizations; }

  /// A pivot this small relative to its column makes a matrix singular to working precision.
  static constexpr double kPivotFloor = 1e-14;

 private:
  void measure_matrix();
  void throw_not_finite(int column) const;
  void measure_columns();
  void refuse_unusable_pattern(const SparseMatrix& A) const;
  /// A solution that is too inaccurate.
  struct Refusal {
    Eigen::Index column = -1;  // of the right-hand sides; −1: none is
    double residual = 0.0;
  };
  void solve_and_check(System system, const MatrixView& B, MatrixSpan X);
  Refusal solve_and_refine(System system, const MatrixView& B, MatrixSpan X);
  void solve_in_place(System system, MatrixSpan X);
  double scaled_residual(System system, const VectorView<double>& b, const VectorView<double>& x);
  double scaled(System system, const VectorView<double>& residual, const VectorView<double>& b,
                const VectorView<double>& x) const;

  SparseMatrix matrix_;
  std::function<std::string(int)> name_of_;
  Eigen::VectorXd row_scale_;
  Eigen::VectorXd row_sum_;
  Eigen::VectorXd column_max_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd refined_;
  Eigen::MatrixXd kept_rhs_;
  Eigen::MatrixXd residuals_;  // of the last solve, if has_residuals_
  bool has_residuals_ = false;
  double norm_inf_ = 0.0;
  double norm_one_ = 0.0;
  bool analyzed_ = false;
  bool factorized_ = false;
  ResidualBounds bounds_;
  SolverStatistics statistics_;
};

}  // namespace hbar::solvers
