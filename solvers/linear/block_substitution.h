#pragma once

#include <Eigen/LU>
#include <memory>
#include <string>
#include <vector>

#include "hbar/solvers/linear/linear_solver.h"
#include "hbar/solvers/linear/sparse_column.h"

namespace hbar::solvers {

/// Dense LU factors of a diagonal block.
using BlockFactors = Eigen::PartialPivLU<Eigen::MatrixXd>;

/// Block substitution for block-lower-triangular matrices: dense LU of each diagonal block, then
/// forward substitution for A x = b and backward for Aᵀ x = b. There is no fill, so for such
/// matrices nothing is faster. Leading zero blocks of a right-hand side (trailing ones for Aᵀ)
/// cost nothing.
class BlockSubstitution final : public LinearSolver {
 public:
  /// @param block_sizes  rows of each diagonal block, all positive  [blocks]
  /// @throws InvalidInput if there is no block or one is not positive
  explicit BlockSubstitution(std::vector<int> block_sizes);

  [[nodiscard]] std::string name() const override { return "block_substitution"; }
  [[nodiscard]] FactorInfo factor_info() const override;
  [[nodiscard]] int block_count() const { return static_cast<int>(factors_.size()); }

  /// Passes in factors of a diagonal block that the caller already has; the next factorize() uses
  /// them instead of factorising that block. Factors of a nearby matrix are detected by the
  /// residual: refined if one step is enough, refused otherwise.
  ///
  /// @param block    index, from 0
  /// @param factors  of diagonal block `block`  [its size x its size]
  /// @throws InvalidInput if there is no such block or the size differs
  void adopt_factors(int block, const BlockFactors& factors);

 private:
  void do_analyze() override;
  void do_factorize() override;
  void do_solve(System system, MatrixSpan X) override;
  bool do_solve_with_residuals(System system, MatrixSpan X, Eigen::MatrixXd& R) override;
  void factorize_block(int block);
  void substitute(System system, MatrixSpan X, Eigen::MatrixXd* R);
  void solve_block(int block, System system, MatrixSpan X_b);
  void subtract_diagonal(int block, System system, const MatrixView& X_b, MatrixSpan R_b) const;
  void subtract_below(int block, MatrixSpan X) const;
  void gather_below(int block, MatrixSpan X) const;
  [[nodiscard]] SparseColumn below_block(int column) const;
  [[nodiscard]] SparseColumn in_block(int column) const;
  [[nodiscard]] int block_of(int row) const;
  [[nodiscard]] int block_begin(int block) const { return begin_[static_cast<std::size_t>(block)]; }
  [[nodiscard]] int block_size(int block) const {
    return begin_[static_cast<std::size_t>(block) + 1] - block_begin(block);
  }

  /// Entries of a block column as a dense matrix, if all of its columns have the same rows without
  /// a gap.
  struct Panel {
    int first_row = 0;
    int rows = 0;  // 0: no such panel
  };
  using DenseView = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  [[nodiscard]] Panel find_panel(int block, bool below) const;
  /// @param first_value  of the block's first column
  [[nodiscard]] DenseView dense_view(int block, const Panel& panel,
                                     const double* first_value) const;

  std::vector<int> begin_;             // first row of each block, and the number of rows
  std::vector<int> below_;             // first entry of each column below its diagonal block
  std::vector<Panel> panels_;          // of each block column, below its diagonal block
  std::vector<Panel> diagonals_;       // of each block column, its diagonal block
  std::vector<BlockFactors> factors_;  // of each diagonal block
  std::vector<char> adopted_;          // factors_[b] was handed in and is not to be computed
  Eigen::MatrixXd block_;              // a diagonal block, dense
  Eigen::MatrixXd work_;               // right-hand sides of a block
};

/// A block substitution as a general solver.
///
/// @param block_sizes  rows of each diagonal block, all positive  [blocks]
/// @throws InvalidInput if there is no block or one is not positive
[[nodiscard]] std::unique_ptr<LinearSolver> make_block_substitution(std::vector<int> block_sizes);

}  // namespace hbar::solvers
