#include "hbar/solvers/linear/block_banded.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "hbar/solvers/linear/accuracy.h"
#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_block_lower;
using testing::random_definite;
using testing::random_dense;

std::unique_ptr<LinearSolver> factorized(const SparseMatrix& A, const std::vector<int>& blocks) {
  auto solver = make_block_banded({.block_sizes = blocks});
  solver->analyze(A);
  solver->factorize(A);
  return solver;
}

/// Largest difference from dense solutions, relative, of both systems.
double error_against_dense(LinearSolver& solver, const SparseMatrix& A) {
  const Eigen::MatrixXd dense(A);
  const Eigen::MatrixXd B = random_dense(static_cast<int>(A.rows()), 3, 5);
  Eigen::MatrixXd X(B.rows(), 3);
  Eigen::MatrixXd Y(B.rows(), 3);
  solver.solve(B, X);
  solver.solve_transposed(B, Y);
  const Eigen::MatrixXd X_dense = dense.partialPivLu().solve(B);
  const Eigen::MatrixXd Y_dense = dense.transpose().partialPivLu().solve(B);
  return std::max((X - X_dense).norm() / X_dense.norm(), (Y - Y_dense).norm() / Y_dense.norm());
}

/// Tridiagonal in blocks, with numbers of no particular size on the diagonal.
SparseMatrix random_tridiagonal(const std::vector<int>& sizes, unsigned seed) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    for (std::size_t a = b == 0 ? 0 : b - 1; a < std::min(b + 2, sizes.size()); ++a) {
      testing::append_block(
          sizes, b, a, random_dense(sizes[b], sizes[a], seed + static_cast<unsigned>(31 * b + a)),
          entries);
    }
  }
  SparseMatrix A(testing::rows_of(sizes), testing::rows_of(sizes));
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// Sets the diagonal blocks to zero.
void empty_diagonal(SparseMatrix& A, int size) {
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      if (entry.row() / size == j / size) {
        entry.valueRef() = 0.0;
      }
    }
  }
}

TEST(BlockBanded, PivotsBelowItsDiagonalBlocks) {
  // Of an even number of blocks; without interchanges between blocks there is no pivot at all.
  for (const int size : {1, 3, 20}) {
    const std::vector<int> blocks(8, size);
    SparseMatrix A = random_tridiagonal(blocks, 3);
    empty_diagonal(A, size);
    const auto solver = factorized(A, blocks);
    EXPECT_LT(error_against_dense(*solver, A), 1e-11) << size;
    EXPECT_EQ(solver->statistics().refinements, 0);
  }
}

TEST(BlockBanded, TakesBlocksOfAnySizesOrNone) {
  for (const std::vector<int>& blocks :
       {std::vector<int>{4, 1, 7, 4, 4, 12, 3, 4}, {39}, {1, 38}, {38, 1}, {}}) {
    const SparseMatrix A = random_tridiagonal({4, 1, 7, 4, 4, 12, 3, 4}, 3);
    EXPECT_LT(error_against_dense(*factorized(A, blocks), A), 1e-11) << blocks.size();
  }
  const SparseMatrix wide = random_definite(std::vector<int>(10, 40), 1);
  EXPECT_LT(error_against_dense(*factorized(wide, {}), wide), 1e-11);
}

TEST(BlockBanded, KeepsTheOutlineOfTheBand) {
  // Block bidiagonal, below: L takes 2 blocks of each column but the last, and U the one above.
  const std::vector<int> blocks(10, 4);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t b = 0; b < 10; ++b) {
    const Eigen::MatrixXd diagonal = 9.0 * Eigen::MatrixXd::Identity(4, 4);
    testing::append_block(blocks, b, b, diagonal + random_dense(4, 4, 1), entries);
    if (b > 0) {
      testing::append_block(blocks, b, b - 1, random_dense(4, 4, 2), entries);
    }
  }
  SparseMatrix A(40, 40);
  A.setFromTriplets(entries.begin(), entries.end());
  const auto solver = factorized(A, blocks);
  EXPECT_EQ(solver->factor_info().entries, 16.0 * (10 + 9 + 9));

  // The strong diagonal needs no interchange, so that what is above it stays zero and costs no
  // work: LU of 10 panels.
  const double tall = 16.0 * (8.0 - 4.0 / 3.0);
  EXPECT_NEAR(solver->factor_info().flops.value_or(0.0), 9.0 * tall + 16.0 * (4.0 - 4.0 / 3.0),
              1e-9);
}

TEST(BlockBanded, DoesNotMindRowsOfVerySmallOrLargeSize) {
  const std::vector<int> blocks = {5, 5, 5};
  const SparseMatrix A = random_tridiagonal(blocks, 7);
  SparseMatrix scaled = A;
  Eigen::VectorXd size(15);
  for (int i = 0; i < 15; ++i) {
    size[i] = std::pow(10.0, 8 * (i % 3 - 1));
  }
  scaled = (size.asDiagonal() * A).eval();
  scaled.makeCompressed();
  const auto solver = factorized(scaled, blocks);
  const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(15, 1.0, 2.0);
  Eigen::VectorXd x(15);
  solver->solve(scaled * expected, x);
  EXPECT_LT((x - expected).norm(), 1e-11);
  EXPECT_EQ(solver->statistics().refinements, 0);
}

TEST(BlockBanded, NamesTheRowThatAPivotWasTakenFrom) {
  // Rows 0 and 2 are interchanged first; what is left of row 0 then has no pivot.
  Eigen::MatrixXd dense(3, 3);
  dense << 1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 2.0, 4.0, 1.0;
  SparseMatrix A = dense.sparseView(1.0, -1.0);
  A.makeCompressed();
  const auto solver = make_block_banded({.block_sizes = {1, 1, 1}});
  solver->name_unknowns([](int index) { return concat("number ", index); });
  solver->analyze(A);
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->factorize(A); }),
            "block_banded: factorize: the matrix (3 x 3) is singular to working precision: the "
            "pivot in row 1 (number 1), column 1 (number 1) is 0; look for an unknown without "
            "stiffness or inertia, or for equations that repeat each other");
}

TEST(BlockBanded, RefusesBlocksThatAreNone) {
  EXPECT_EQ(message_of<InvalidInput>([] {
              static_cast<void>(make_block_banded({.block_sizes = {2, 0}}));
            }),
            "block_banded: block 1 has size 0; expected a positive number");
  EXPECT_EQ(message_of<InvalidInput>([] {
              factorized(random_block_lower({2, 2}, 1), {2, 3});
            }),
            "block_banded: analyze: the blocks have 5 rows in all, the matrix has 4");
  EXPECT_EQ(message_of<InvalidInput>(
                [] { static_cast<void>(make_block_banded({.ordering = Ordering::kAmd})); }),
            "block_banded: the ordering \"amd\" is not offered; offered: default, natural");
}

TEST(BlockBanded, RefusesABandThatIsNone) {
  const int size = 40000;
  SparseMatrix A(size, size);
  A.setIdentity();
  A.insert(size - 1, 0) = 1.0;
  A.makeCompressed();
  const std::string message = message_of<InvalidInput>([&] { make_block_banded()->analyze(A); });
  EXPECT_NE(message.find("allowed: 8.58993e+09; use klu or umfpack"), std::string::npos) << message;
}

}  // namespace
}  // namespace hbar::solvers
